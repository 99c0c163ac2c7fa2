// The arithmetic of the steps of a rig (RigStep in fsm/rig/rig_data.h), written once in what C++ and
// GLSL have in common: fsm/rig/steps.h compiles it for the processor, gpu_rig.cc puts it before
// render/shaders/rig_kernels.glsl for a graphics card. FUNCTION is "inline" in C++ and nothing in
// GLSL. Members of structs have 32 bits each, so that they lie alike in memory (std430).
// Lengths are millimetres and angles radians where nothing else is said.

const float kCorneaRadius = 8.0f;  // outer
const float kLidRadius = 13.35f;   // turns millimetres at a lid's edge into an angle
const float kLidThickness = 0.35f;  // of a lid over the cornea
const float kMostOpen = 0.5f;       // of a jaw that follows the chin
// How much of a push by the teeth counts, by the height over their edge: none, all.
const float kPastTeeth = -2.2f, kBesideTeeth = 0.2f;
// How far a row of teeth curves back, by the square and the fourth power of the place along it.
const float kArchSquare = 0.45f, kArchFourth = 0.55f;

const float kTongueRaise = 13.0f;  // of the tip
const float kTongueOffJaw = 0.8f;  // a raised tip stays when the jaw drops
const float kTongueNoRoom = 2.5f, kTongueRoom = 5.5f;  // between teeth and lips
const float kTongueSkin = 0.6f;     // kept between the tongue and what it touches
const float kTongueEdges = 0.9f;    // teeth are not all of one height
const float kBehindTeeth = 3.5f;    // of the arch, which is their outer face
const float kTongueOut = 1.5f;      // put out this far it goes over the teeth
const float kTongueWidest = 17.0f;  // half its width at rest
const float kTongueInArch = 11.0f;  // and what goes through between the canines
const float kTongueInLips = 0.35f;  // of the width between the lips, half the tongue's
// It is made narrow enough for the lips this far behind the front teeth: not at all, wholly.
const float kTongueWide = 16.0f, kTongueNarrow = 5.0f;
// Teeth and lips hold it this far before and behind them: not at all, wholly.
const float kTongueFree = 15.0f, kTongueHeld = 9.0f;

struct Point {
  float x, y, z;
};
FUNCTION vec3 Vec(Point p) { return vec3(p.x, p.y, p.z); }
FUNCTION Point PointAt(vec3 p) { return Point(p.x, p.y, p.z); }

// A rotation: where it takes the three axes.
struct Turn {
  Point x, y, z;
};
FUNCTION vec3 Turned(Turn turn, vec3 p) { return Vec(turn.x) * p.x + Vec(turn.y) * p.y + Vec(turn.z) * p.z; }

// ---- The jaw: it turns about a hinge along x, slides forward and sways to the viewer's right.

struct Jaw {
  float open, slide, sway;
  float cosine, sine;  // of `open`
  float hinge_y, hinge_z;
};

FUNCTION Jaw JawAt(float open, float slide, float sway, float hinge_y, float hinge_z) {
  return Jaw(open, slide, sway, cos(open), sin(open), hinge_y, hinge_z);
}

// Where a point goes that takes part in the jaw's motion by `weight`. Sideways the jaw takes more of
// the lips along: corners 5 and upper lip 1.6 mm of a chin's 8.6.
FUNCTION vec3 WithJaw(Jaw jaw, vec3 p, float weight) {
  float angle = jaw.open * weight;
  float c = weight == 1.0f ? jaw.cosine : cos(angle);
  float s = weight == 1.0f ? jaw.sine : sin(angle);
  float y = p.y - jaw.hinge_y;
  float z = p.z - jaw.hinge_z;
  float sway = jaw.sway == 0.0f ? 0.0f : sqrt(weight) * jaw.sway;
  return vec3(p.x + sway, jaw.hinge_y + y * c - z * s, jaw.hinge_z + z * c + y * s + weight * jaw.slide);
}

// Where a point would lie in the jaw at rest.
FUNCTION vec3 IntoJaw(Jaw jaw, vec3 p) {
  float y = p.y - jaw.hinge_y;
  float z = p.z - jaw.hinge_z - jaw.slide;
  return vec3(p.x - jaw.sway, jaw.hinge_y + y * jaw.cosine + z * jaw.sine,
              jaw.hinge_z + z * jaw.cosine - y * jaw.sine);
}

// The normal at `p` of what is fixed to the jaw.
FUNCTION vec3 NormalWithJaw(Jaw jaw, vec3 p, vec3 normal) {
  return normalize(WithJaw(jaw, p + normal, 1.0f) - WithJaw(jaw, p, 1.0f));
}

// The jaw as far open as the chin has gone, from `before` to `after`.
FUNCTION Jaw JawByChin(Jaw jaw, vec3 before, vec3 after) {
  float was = atan(jaw.hinge_y - before.y, before.z - jaw.hinge_z);
  float now = atan(jaw.hinge_y - after.y, after.z - jaw.hinge_z);
  return JawAt(clamp(now - was, 0.0f, kMostOpen), 0.0f, after.x - before.x, jaw.hinge_y, jaw.hinge_z);
}

// ---- Lids and eyes.

// What a vertex of the lids is to them: a place in the frame of the eye before its EyeTransform;
// angles up from straight ahead.
struct LidPoint {
  float upper, lower;              // part in each lid's turn, 0..1
  float upper_angle, lower_angle;  // of the rims at rest
  float meet_angle;                // where the closed lids meet
  float opening;                   // how far the lids stand apart here, of the widest place
  float y, z;                      // at rest from the axis of the lids
};

struct Eye {
  Turn gaze;         // of the eyeball, about `pivot`
  Point pivot;
  Point ball;        // the centre of the ball that lids stay outside of
  Point cornea;      // its centre
  float size;        // the eye's, of the table's
  float tilt_cosine, tilt_sine;  // of the eye in the face, about the line of sight, times `size`
  float upper_open, lower_open;  // how far the rims stand above those of the table
  float lower_raised;
  float close;       // 0 = not at all, 1 = the lids meet
};

// The angle by which a vertex turns about the axis of the lids. A lower lid that is raised goes up
// nearly as far beside the middle, so that it stays a curve.
FUNCTION float LidTurn(LidPoint lid, Eye eye) {
  float upper = lid.upper_angle + lid.opening * eye.upper_open / kLidRadius;
  float raised = eye.lower_raised * (eye.lower_raised > 0.0f ? sqrt(lid.opening) : lid.opening);
  float lower = lid.lower_angle + (lid.opening * eye.lower_open + raised) / kLidRadius;
  if (upper < lower) upper = lower = 0.5f * (upper + lower);
  upper += eye.close * (lid.meet_angle - upper);
  lower += eye.close * (lid.meet_angle - lower);
  return lid.upper * (upper - lid.upper_angle) + lid.lower * (lower - lid.lower_angle);
}

FUNCTION vec3 WithLids(LidPoint lid, Eye eye, vec3 p) {
  float turn = LidTurn(lid, eye);
  if (turn == 0.0f) return p;
  float c = cos(turn);
  float s = sin(turn);
  float y = lid.y * c + lid.z * s - lid.y;
  return p + vec3(-eye.tilt_sine * y, eye.tilt_cosine * y, eye.size * (lid.z * c - lid.y * s - lid.z));
}

// A point pushed out of a ball. What is near the centre is not of the lid, and stays.
FUNCTION vec3 OutOfBall(vec3 centre, float radius, vec3 p) {
  vec3 off = p - centre;
  float distance = length(off);
  return distance < radius && distance > 1.0f ? centre + off * (radius / distance) : p;
}

FUNCTION vec3 WithGaze(Eye eye, vec3 p) {
  return Vec(eye.pivot) + Turned(eye.gaze, p - Vec(eye.pivot));
}

// The cornea bulges the lid it rolls under.
FUNCTION vec3 OverCornea(Eye eye, vec3 p) {
  return OutOfBall(Vec(eye.cornea), eye.size * (kCorneaRadius + kLidThickness), p);
}

// ---- Teeth.

// One row of teeth: the outer faces lie on a parabola, flattened in front by a part of fourth order
// (dental arches are nearer to a U than to a V).
struct ToothArch {
  float front_z, depth, half_width;
  float edge_y;  // of the middle incisors
  float root_y;  // where the gum ends
  float middle_x;
  float turn;    // forward for each millimetre to the left
};

FUNCTION float ArchZ(ToothArch arch, float x) {
  float off = x - arch.middle_x;
  float t = (off / arch.half_width) * (off / arch.half_width);
  return arch.front_z + arch.turn * off - arch.depth * t * (kArchSquare + kArchFourth * t);
}

// How much of a push counts, by height: all beside the crowns, fading past the edge.
FUNCTION float BesideCrowns(ToothArch arch, float y) {
  float down = arch.root_y > arch.edge_y ? 1.0f : -1.0f;
  return SmoothStep(kPastTeeth, kBesideTeeth, down * (y - arch.edge_y));
}

struct Mouth {
  Jaw jaw;
  ToothArch upper, lower;  // at rest
  float seal;              // 0 = lips that have crossed touch, 1 = there is no gap between lips
  float tongue_raise;      // 0..1
  float tongue_out;
};

// A point of the lips held off the teeth: by these gaps at least off either arch.
FUNCTION vec3 OffTeeth(Mouth mouth, vec3 p, float upper_gap, float lower_gap) {
  float upper = ArchZ(mouth.upper, p.x) + upper_gap - p.z;
  if (upper > 0.0f) p.z += upper * BesideCrowns(mouth.upper, p.y);
  vec3 q = IntoJaw(mouth.jaw, p);
  float lower = ArchZ(mouth.lower, q.x) + lower_gap - q.z;
  if (lower <= 0.0f) return p;
  q.z += lower * BesideCrowns(mouth.lower, q.y);
  return WithJaw(mouth.jaw, q, 1.0f);
}

// ---- Lips: by how much a pair that meets in a closed mouth is too far apart, or has crossed.

FUNCTION vec3 LipGap(float seal, vec3 upper, vec3 lower, vec3 apart_at_rest) {
  vec3 apart = upper - lower - apart_at_rest;
  vec3 gap = seal * apart;
  gap.y += (1.0f - seal) * min(apart.y, 0.0f);
  return gap;
}

// ---- The tongue. It is soft and takes the form of what it goes through: between the edges of the
// teeth, then between the lips. Where there is no room it stays behind the teeth.

struct TonguePath {
  float teeth_low, teeth_high, front_z;
  float room;                // between lips and teeth, at the widest place
  float open_from, open_to;  // the open part of the lips, by x
};

// The way of the tongue past the teeth; LipsOnPath adds each pair of the lips that meet.
FUNCTION TonguePath PathPastTeeth(Mouth mouth) {
  vec3 edge = WithJaw(mouth.jaw, vec3(0.0f, mouth.lower.edge_y, mouth.lower.front_z), 1.0f);
  return TonguePath(edge.y, mouth.upper.edge_y, max(mouth.upper.front_z, edge.z), 0.0f, 0.0f, 0.0f);
}
FUNCTION TonguePath LipsOnPath(TonguePath path, vec3 upper, vec3 lower) {
  float gap = upper.y - lower.y;
  path.room = max(path.room, min(gap, min(upper.y - path.teeth_low, path.teeth_high - lower.y)));
  if (gap <= kTongueNoRoom) return path;
  path.open_from = min(path.open_from, upper.x);
  path.open_to = max(path.open_to, upper.x);
  return path;
}

// How far a tongue comes out that is asked to: by how far the mouth is open.
FUNCTION float ComesOut(TonguePath path, Mouth mouth) {
  float room = min(path.room, path.teeth_high - path.teeth_low);
  return mouth.tongue_out * SmoothStep(kTongueNoRoom, kTongueRoom, room);
}

// A place of the tongue raised, put out by `out_mm` and moved with the jaw. `tip`: 0 = root, 1 = tip.
FUNCTION vec3 RaisedTongue(Mouth mouth, float out_mm, vec3 p, float tip) {
  p.z += out_mm * tip;
  p.y += mouth.tongue_raise * kTongueRaise * tip * tip;
  return WithJaw(mouth.jaw, p, 1.0f - kTongueOffJaw * mouth.tongue_raise * tip);
}

// The front face of the lower teeth beside a place of the tongue.
FUNCTION float LowerTeethZ(Mouth mouth, float x) {
  x -= mouth.jaw.sway;
  return WithJaw(mouth.jaw, vec3(x, mouth.lower.edge_y, ArchZ(mouth.lower, x)), 1.0f).z;
}

FUNCTION vec3 BehindTeeth(Mouth mouth, vec3 p) {
  float teeth_z = min(LowerTeethZ(mouth, p.x), ArchZ(mouth.upper, p.x));
  return vec3(p.x, p.y, min(p.z, teeth_z - kBehindTeeth));
}

// A place narrowed to what fits between canines and lips.
FUNCTION vec3 NarrowTongue(TonguePath path, vec3 p) {
  float middle_x = 0.5f * (path.open_from + path.open_to);
  float width = min(kTongueInArch, kTongueInLips * (path.open_to - path.open_from)) / kTongueWidest;
  p.x += SmoothStep(path.front_z - kTongueWide, path.front_z - kTongueNarrow, p.z) *
         (middle_x + min(1.0f, width) * p.x - p.x);
  return p;
}

// How firmly what lies at `z` holds the tongue at `tongue_z`, a little before and behind it, too, as
// its surface is made of triangles.
FUNCTION float Held(float tongue_z, float z) {
  return SmoothStep(z - kTongueFree, z - kTongueHeld, tongue_z) *
         SmoothStep(z + kTongueFree, z + kTongueHeld, tongue_z);
}

// A place of the narrowed tongue over the lower teeth and lip and under the upper ones; `high` and
// `low` are the lips at its x. Lips come last: they are seen. `lower_z`: LowerTeethZ before it was narrowed.
FUNCTION vec3 BetweenLips(TonguePath path, Mouth mouth, vec3 p, float lower_z, vec3 high, vec3 low) {
  p.y += Held(p.z, lower_z) * max(0.0f, path.teeth_low + kTongueEdges - p.y);
  p.y += Held(p.z, ArchZ(mouth.upper, p.x)) * min(0.0f, path.teeth_high - kTongueEdges - p.y);
  float middle_y = 0.5f * (low.y + high.y);
  p.y += Held(p.z, low.z) * max(0.0f, min(low.y + kTongueSkin, middle_y) - p.y);
  p.y += Held(p.z, high.z) * min(0.0f, max(high.y - kTongueSkin, middle_y) - p.y);
  return p;
}

// ---- The head turns about a point of the neck and goes forward.

struct Neck {
  Turn turn;
  Point pivot;
  float forward;
};

FUNCTION vec3 WithNeck(Neck neck, vec3 p, float weight) {
  vec3 turned = Vec(neck.pivot) + Turned(neck.turn, p - Vec(neck.pivot));
  turned.z += neck.forward;
  return p + weight * (turned - p);
}

// ---- All that the steps read of one state.

struct StepState {
  Mouth mouth;
  Eye eyes[2];  // by Side
  Neck neck;
};

// ---- Normals of skin.

// Of a triangle, as long as its area is large.
FUNCTION vec3 TriangleNormal(vec3 a, vec3 b, vec3 c) { return cross(b - a, c - a); }
FUNCTION vec3 UnitNormal(vec3 sum) {
  float squared = dot(sum, sum);
  return squared > 1e-12f ? sum / sqrt(squared) : vec3(0.0f, 0.0f, 1.0f);
}

// ---- What a graphics card is told of vertices (fsm/render/rig_records.h packs it).

// Of a vertex with a list of entries: from `from` to before `to`.
struct ListRecord {
  uint vertex, from, to;
};
struct PlaceRecord {
  Point position, normal;
};
struct ChannelEntry {
  uint channel;
  Point by;
};
struct LidRecord {
  uint vertex, side;
  LidPoint at;
  uint proper;  // 0 or 1
};
struct BallLidRecord {
  uint vertex, side;
  float least;
};
struct JawRecord {
  uint vertex;
  float weight;
};
struct ChinRecord {
  uint vertex;
  Point rest;
};
struct ContactRecord {
  uint vertex;
  float upper_gap, lower_gap;
};
struct GapRecord {
  uint upper, lower;
  Point apart_at_rest;
};
struct LipEntry {
  uint pair;
  float share;
};
struct TongueRecord {
  uint vertex;
  Point rest, rest_normal;
  float tip;
};
struct SeamEntry {
  uint upper, lower;
};
const uint kJawBone = 2u;
struct BoneRecord {
  uint vertex, bone;  // the Side of an eye, or kJawBone
};
struct NeckRecord {
  float weight;
  uint turns_normal;  // 0 or 1
};
struct SpringEntry {
  uint spring;
  float weight;
};
struct TriangleEntry {
  uint a, b, c;
};
