// The arithmetic of the steps of a rig (RigStep in fsm/rig/rig_data.h), written once in the common subset of C++ and
// GLSL: fsm/rig/steps.h compiles it for the processor, gpu_rig.cc prepends it to render/shaders/rig_kernels.glsl for
// a GPU. FUNCTION is "inline" in C++ and empty in GLSL. Members of structs in buffers have 32 bits each, so
// that both lay them out alike (std430). Lengths are in millimetres and angles in radians unless stated otherwise.

const float kCorneaRadius = 8.0f;  // of the outer surface
// Converts millimetres at a lid's edge to an angle: the mean radius, 4 mm to either side of the eye's middle, of the
// surface that the lids slide on (lid_value in head/tables/eye.txt; the angles at rest come from the radius itself).
const float kLidRadius = 13.35f;
const float kLidThickness = 0.35f;  // where the lid covers the cornea
const float kMaxOpen = 0.5f;       // limit for a jaw that follows the chin
// A push by the teeth fades with the height from their edge towards the root: 0 below the first, 1 above the second.
const float kPastTeeth = -2.2f, kBesideTeeth = 0.2f;
// Coefficients of the parabola and the quartic by which a row of teeth curves back.
const float kArchSquare = 0.45f, kArchFourth = 0.55f;

const float kTongueRaise = 13.0f;  // height of the raised tip
const float kTongueOffJaw = 0.8f;  // fraction of the jaw's rotation that a raised tip resists
const float kTongueNoRoom = 2.5f, kTongueRoom = 5.5f;  // least and full height of its way out
const float kTongueSkin = 0.6f;     // clearance between the tongue and what it touches
const float kTongueEdges = 0.9f;    // clearance for teeth of unequal height
const float kBehindTeeth = 3.5f;    // distance behind the dental arch, which is the teeth's outer face
const float kTongueOut = 1.5f;      // from this protrusion on the tongue goes over the teeth
const float kTongueWidest = 17.0f;  // half its width at rest
const float kTongueInArch = 11.0f;  // half the width that fits between the canines
const float kTongueInLips = 0.35f;  // half the tongue's width as a fraction of the width between the lips
// The tongue narrows to fit the lips over this range behind the front teeth: from not at all to fully.
const float kTongueWide = 16.0f, kTongueNarrow = 5.0f;
// Teeth and lips hold the tongue over this range before and behind them: from not at all to fully.
const float kTongueFree = 15.0f, kTongueHeld = 9.0f;

// Returns 0 below `from`, 1 above `to`, and a smooth cubic between; `from` may exceed `to`.
FUNCTION float SmoothStep(float from, float to, float x) {
  float t = clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

struct Point {
  float x, y, z;
};
FUNCTION vec3 Vec(Point p) { return vec3(p.x, p.y, p.z); }
FUNCTION Point PointAt(vec3 p) { return Point(p.x, p.y, p.z); }

// A rotation: the images of the three axes (columns of its matrix).
struct Rotation {
  Point x, y, z;
};
FUNCTION vec3 Rotated(Rotation by, vec3 p) { return Vec(by.x) * p.x + Vec(by.y) * p.y + Vec(by.z) * p.z; }

// ---- The jaw rotates about a hinge along x, slides forward and sways to the viewer's right.

struct Jaw {
  float open, slide, sway;
  float cosine, sine;  // of `open`
  float hinge_y, hinge_z;
};

FUNCTION Jaw JawAt(float open, float slide, float sway, float hinge_y, float hinge_z) {
  return Jaw(open, slide, sway, cos(open), sin(open), hinge_y, hinge_z);
}

// Moves a point with the jaw by `weight`. Sideways the jaw takes more of the lips along (sqrt): mouth corners move
// 5 mm and the upper lip 1.6 mm when the chin moves 8.6 mm.
FUNCTION vec3 WithJaw(Jaw jaw, vec3 p, float weight) {
  float angle = jaw.open * weight;
  float c = weight == 1.0f ? jaw.cosine : cos(angle);
  float s = weight == 1.0f ? jaw.sine : sin(angle);
  float y = p.y - jaw.hinge_y;
  float z = p.z - jaw.hinge_z;
  float sway = jaw.sway == 0.0f ? 0.0f : sqrt(weight) * jaw.sway;
  return vec3(p.x + sway, jaw.hinge_y + y * c - z * s, jaw.hinge_z + z * c + y * s + weight * jaw.slide);
}

// Maps a point into the frame of the jaw at rest: the inverse of WithJaw with weight 1.
FUNCTION vec3 IntoJaw(Jaw jaw, vec3 p) {
  float y = p.y - jaw.hinge_y;
  float z = p.z - jaw.hinge_z - jaw.slide;
  return vec3(p.x - jaw.sway, jaw.hinge_y + y * jaw.cosine + z * jaw.sine,
              jaw.hinge_z + z * jaw.cosine - y * jaw.sine);
}

// Rotates the normal at `p` of a part that is fixed to the jaw.
FUNCTION vec3 NormalWithJaw(Jaw jaw, vec3 p, vec3 normal) {
  return normalize(WithJaw(jaw, p + normal, 1.0f) - WithJaw(jaw, p, 1.0f));
}

// Returns the jaw opened as far as the chin has moved, from `before` to `after`.
FUNCTION Jaw JawByChin(Jaw jaw, vec3 before, vec3 after) {
  float was = atan(jaw.hinge_y - before.y, before.z - jaw.hinge_z);
  float now = atan(jaw.hinge_y - after.y, after.z - jaw.hinge_z);
  return JawAt(clamp(now - was, 0.0f, kMaxOpen), 0.0f, after.x - before.x, jaw.hinge_y, jaw.hinge_z);
}

// ---- Lids and eyes.

// A lid's vertex in the frame of the eye before its EyeTransform. Angles are upward from straight ahead.
struct LidPlace {
  float upper, lower;              // part in each lid's rotation, 0..1
  float upper_angle, lower_angle;  // of the lid margins at rest
  float meet_angle;                // where the closed lids meet
  float opening;                   // height of the eye's opening here as a fraction of the widest
  float y, z;                      // at rest, from the axis of the lids
};

struct Eye {
  Rotation gaze;     // of the eyeball, about `pivot`
  Point pivot;
  Point ball;        // centre of the ball that lids stay outside of
  Point cornea;      // centre of its sphere
  float size;        // relative to the table's eye
  float tilt_cosine, tilt_sine;  // of the eye's roll in the face, times `size`
  float upper_open, lower_open;  // how far the margins stand above those of the table
  float lower_raised;
  float close;       // 0 = not at all, 1 = the lids meet
};

// Returns the angle by which a vertex rotates about the axis of the lids. A raised lower lid goes up nearly as far
// beside the middle (sqrt), so that it stays a curve.
FUNCTION float LidAngle(LidPlace lid, Eye eye) {
  float upper = lid.upper_angle + lid.opening * eye.upper_open / kLidRadius;
  float raised = eye.lower_raised * (eye.lower_raised > 0.0f ? sqrt(lid.opening) : lid.opening);
  float lower = lid.lower_angle + (lid.opening * eye.lower_open + raised) / kLidRadius;
  if (upper < lower) upper = lower = 0.5f * (upper + lower);
  upper += eye.close * (lid.meet_angle - upper);
  lower += eye.close * (lid.meet_angle - lower);
  return lid.upper * (upper - lid.upper_angle) + lid.lower * (lower - lid.lower_angle);
}

FUNCTION vec3 WithLids(LidPlace lid, Eye eye, vec3 p) {
  float angle = LidAngle(lid, eye);
  if (angle == 0.0f) return p;
  float c = cos(angle);
  float s = sin(angle);
  float y = lid.y * c + lid.z * s - lid.y;
  return p + vec3(-eye.tilt_sine * y, eye.tilt_cosine * y, eye.size * (lid.z * c - lid.y * s - lid.z));
}

// Pushes a point out of a ball. A point within 1 mm of the centre is not of the lid and stays.
FUNCTION vec3 OutOfBall(vec3 centre, float radius, vec3 p) {
  vec3 off = p - centre;
  float distance = length(off);
  return distance < radius && distance > 1.0f ? centre + off * (radius / distance) : p;
}

FUNCTION vec3 WithGaze(Eye eye, vec3 p) {
  return Vec(eye.pivot) + Rotated(eye.gaze, p - Vec(eye.pivot));
}

// The cornea bulges the lid that it moves under.
FUNCTION vec3 OverCornea(Eye eye, vec3 p) {
  return OutOfBall(Vec(eye.cornea), eye.size * (kCorneaRadius + kLidThickness), p);
}

// ---- Teeth.

// One row of teeth: the outer faces lie on a parabola, flattened in front by a quartic term (dental arches are nearer
// to a U than to a V).
struct ToothArch {
  float front_z, depth, half_width;
  float edge_y;  // height of the central incisors' edges
  float root_y;  // height where the gum begins
  float middle_x;
  float slope;   // forward, per millimetre to the left
};

FUNCTION float ArchZ(ToothArch arch, float x) {
  float off = x - arch.middle_x;
  float t = (off / arch.half_width) * (off / arch.half_width);
  return arch.front_z + arch.slope * off - arch.depth * t * (kArchSquare + kArchFourth * t);
}

// Returns the fraction of a push at height y: 1 beside the crowns, fading out past the edge.
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

// Pushes a point of the lips off both rows of teeth, to these distances at least.
FUNCTION vec3 OffTeeth(Mouth mouth, vec3 p, float upper_gap, float lower_gap) {
  float upper = ArchZ(mouth.upper, p.x) + upper_gap - p.z;
  if (upper > 0.0f) p.z += upper * BesideCrowns(mouth.upper, p.y);
  vec3 q = IntoJaw(mouth.jaw, p);
  float lower = ArchZ(mouth.lower, q.x) + lower_gap - q.z;
  if (lower <= 0.0f) return p;
  q.z += lower * BesideCrowns(mouth.lower, q.y);
  return WithJaw(mouth.jaw, q, 1.0f);
}

// ---- Lips: the correction of a pair of vertices that is too far apart while sealed, or has crossed.

FUNCTION vec3 LipGap(float seal, vec3 upper, vec3 lower, vec3 apart_at_rest) {
  vec3 apart = upper - lower - apart_at_rest;
  vec3 gap = seal * apart;
  gap.y += (1.0f - seal) * min(apart.y, 0.0f);
  return gap;
}

// ---- The tongue is soft and adapts to what it passes: the edges of the teeth, then the lips. Where there is no room
// it stays behind the teeth.

// A pair of lip vertices, or a point interpolated between two pairs.
struct LipPair {
  vec3 upper, lower;
};

// Interpolates at `x` between neighbouring pairs, `a` on the side of -x; beyond them it is the nearer one.
FUNCTION LipPair LipsBetween(LipPair a, LipPair b, float x) {
  float t = clamp((x - a.upper.x) / max(b.upper.x - a.upper.x, 1e-3f), 0.0f, 1.0f);
  return LipPair(mix(a.upper, b.upper, t), mix(a.lower, b.lower, t));
}

struct TonguePath {
  float teeth_low, teeth_high, front_z;
  float room;                // greatest free height between lips and teeth
  float open_from, open_to;  // x range where the lips are open
};

// Returns the tongue's path past the teeth; LipsOnPath then adds each pair of lip vertices.
FUNCTION TonguePath PathPastTeeth(Mouth mouth) {
  vec3 edge = WithJaw(mouth.jaw, vec3(0.0f, mouth.lower.edge_y, mouth.lower.front_z), 1.0f);
  return TonguePath(edge.y, mouth.upper.edge_y, max(mouth.upper.front_z, edge.z), 0.0f, 0.0f, 0.0f);
}
FUNCTION TonguePath LipsOnPath(TonguePath path, LipPair lips) {
  float gap = lips.upper.y - lips.lower.y;
  path.room = max(path.room, min(gap, min(lips.upper.y - path.teeth_low, path.teeth_high - lips.lower.y)));
  if (gap <= kTongueNoRoom) return path;
  path.open_from = min(path.open_from, lips.upper.x);
  path.open_to = max(path.open_to, lips.upper.x);
  return path;
}

// Returns how far the tongue comes out, millimetres: the protrusion asked for, limited by the mouth's opening.
FUNCTION float TongueProtrusion(TonguePath path, Mouth mouth) {
  float room = min(path.room, path.teeth_high - path.teeth_low);
  return mouth.tongue_out * SmoothStep(kTongueNoRoom, kTongueRoom, room);
}

// Moves a point of the tongue: raised, put out by `out_mm`, then with the jaw. `tip`: 0 = root, 1 = tip.
FUNCTION vec3 RaisedTongue(Mouth mouth, float out_mm, vec3 p, float tip) {
  p.z += out_mm * tip;
  p.y += mouth.tongue_raise * kTongueRaise * tip * tip;
  return WithJaw(mouth.jaw, p, 1.0f - kTongueOffJaw * mouth.tongue_raise * tip);
}

// Returns z of the lower teeth's front face beside a point of the tongue.
FUNCTION float LowerTeethZ(Mouth mouth, float x) {
  x -= mouth.jaw.sway;
  return WithJaw(mouth.jaw, vec3(x, mouth.lower.edge_y, ArchZ(mouth.lower, x)), 1.0f).z;
}

FUNCTION vec3 BehindTeeth(Mouth mouth, vec3 p) {
  float teeth_z = min(LowerTeethZ(mouth, p.x), ArchZ(mouth.upper, p.x));
  return vec3(p.x, p.y, min(p.z, teeth_z - kBehindTeeth));
}

// Narrows the tongue at a point to the width that fits between canines and lips.
FUNCTION vec3 NarrowTongue(TonguePath path, vec3 p) {
  float middle_x = 0.5f * (path.open_from + path.open_to);
  float width = min(kTongueInArch, kTongueInLips * (path.open_to - path.open_from)) / kTongueWidest;
  p.x += SmoothStep(path.front_z - kTongueWide, path.front_z - kTongueNarrow, p.z) *
         (middle_x + min(1.0f, width) * p.x - p.x);
  return p;
}

// Returns how firmly an obstacle at `z` holds the tongue at `tongue_z`, 0..1. It also acts a little before and behind
// it, since the surface consists of triangles.
FUNCTION float Held(float tongue_z, float z) {
  return SmoothStep(z - kTongueFree, z - kTongueHeld, tongue_z) *
         SmoothStep(z + kTongueFree, z + kTongueHeld, tongue_z);
}

// Keeps a point of the narrowed tongue above the lower teeth and lip and below the upper ones. Lips come last, since
// they are visible. `lips`: at its x. `lower_z`: LowerTeethZ before narrowing.
FUNCTION vec3 BetweenLips(TonguePath path, Mouth mouth, vec3 p, float lower_z, LipPair lips) {
  p.y += Held(p.z, lower_z) * max(0.0f, path.teeth_low + kTongueEdges - p.y);
  p.y += Held(p.z, ArchZ(mouth.upper, p.x)) * min(0.0f, path.teeth_high - kTongueEdges - p.y);
  float middle_y = 0.5f * (lips.lower.y + lips.upper.y);
  p.y += Held(p.z, lips.lower.z) * max(0.0f, min(lips.lower.y + kTongueSkin, middle_y) - p.y);
  p.y += Held(p.z, lips.upper.z) * min(0.0f, max(lips.upper.y - kTongueSkin, middle_y) - p.y);
  return p;
}

// Moves a point of the raised tongue that is put out by `out_mm`, from behind the teeth to between the lips. `lips`:
// at the x that the point has once NarrowTongue has moved it.
FUNCTION vec3 TongueOverTeeth(TonguePath path, Mouth mouth, float out_mm, vec3 p, LipPair lips) {
  vec3 out_point = BetweenLips(path, mouth, NarrowTongue(path, p), LowerTeethZ(mouth, p.x), lips);
  return mix(BehindTeeth(mouth, p), out_point, SmoothStep(0.0f, kTongueOut, out_mm));
}

// ---- The head turns about a point of the neck and goes forward.

struct Neck {
  Rotation rotation;
  Point pivot;
  float forward;
};

FUNCTION vec3 WithNeck(Neck neck, vec3 p, float weight) {
  vec3 moved = Vec(neck.pivot) + Rotated(neck.rotation, p - Vec(neck.pivot));
  moved.z += neck.forward;
  return p + weight * (moved - p);
}

// ---- All values that the steps read of one state.

struct StepState {
  Mouth mouth;
  Eye eyes[2];  // by Side
  Neck neck;
};

// ---- Normals of skin.

// Returns the normal of a triangle; its length is twice the area.
FUNCTION vec3 TriangleNormal(vec3 a, vec3 b, vec3 c) { return cross(b - a, c - a); }
FUNCTION vec3 UnitNormal(vec3 sum) {
  float squared = dot(sum, sum);
  return squared > 1e-12f ? sum / sqrt(squared) : vec3(0.0f, 0.0f, 1.0f);
}

// ---- Records of vertices for a GPU (rig_records.h packs them).

// A vertex with a list of entries, from index `from` up to but excluding `to`.
struct ListRecord {
  uint vertex, from, to;
};
struct RestRecord {
  Point position, normal;
};
struct ChannelEntry {
  uint channel;
  Point offset;
};
struct LidRecord {
  uint vertex, side;
  LidPlace point;
  uint is_lid;  // 0 or 1
};
struct BallLidRecord {
  uint vertex, side;
  float min_radius;
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
  uint vertex, bone;  // bone: the Side of an eye, or kJawBone
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
