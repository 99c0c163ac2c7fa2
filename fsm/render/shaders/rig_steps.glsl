// The steps of Rig::Take (fsm/rig/rig.cc) on a graphics card, one program for each: gpu_rig.cc puts before
// this the version, the places of the members of a pose (those of an eye are from RIGHT_EYE or LEFT_EYE on,
// those of a row of teeth, a ToothArch, from UPPER_ARCH or LOWER_ARCH on), the numbers of step_constants.h,
// kCorneaRadius, kNeckPivot and which step it is. An invocation moves one vertex of one face.
// `items` holds what a step knows of its vertices: records of RECORD numbers, a struct of rig_items.cc whose
// members are read here in their order. Where several things act on a vertex, they are entries of ENTRY
// numbers behind all records, and a ListRecord says from where to where.
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Positions { float positions[]; };
layout(std430, binding = 1) buffer Normals { float normals[]; };
layout(std430, binding = 2) buffer Poses {
  uint vertex_count;
  uint pose_size;
  uint swings_at;  // in a pose
  uint seam_at;
  float poses[];
};
layout(std430, binding = 3) readonly buffer Items {
  uint item_count;
  uint items[];
};

uint Face() { return gl_GlobalInvocationID.y; }
uint At(uint vertex) { return 3u * (Face() * vertex_count + vertex); }
vec3 Position(uint vertex) {
  uint i = At(vertex);
  return vec3(positions[i], positions[i + 1u], positions[i + 2u]);
}
void SetPosition(uint vertex, vec3 p) {
  uint i = At(vertex);
  positions[i] = p.x;
  positions[i + 1u] = p.y;
  positions[i + 2u] = p.z;
}
vec3 Normal(uint vertex) {
  uint i = At(vertex);
  return vec3(normals[i], normals[i + 1u], normals[i + 2u]);
}
void SetNormal(uint vertex, vec3 n) {
  uint i = At(vertex);
  normals[i] = n.x;
  normals[i + 1u] = n.y;
  normals[i + 2u] = n.z;
}
float Number(uint i) { return uintBitsToFloat(items[i]); }
vec3 Place(uint i) { return vec3(Number(i), Number(i + 1u), Number(i + 2u)); }
float Pose(uint i) { return poses[Face() * pose_size + i]; }
vec3 Pose3(uint i) { return vec3(Pose(i), Pose(i + 1u), Pose(i + 2u)); }
mat3 PoseMatrix(uint i) { return mat3(Pose3(i), Pose3(i + 3u), Pose3(i + 6u)); }
void SetPose(uint i, float value) { poses[Face() * pose_size + i] = value; }

float SmoothStep(float from, float to, float x) {
  float t = clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

vec3 TurnJaw(vec3 p, float weight) {
  float angle = Pose(JAW_ANGLE) * weight;
  float c = weight == 1.0 ? Pose(JAW_COS) : cos(angle);
  float s = weight == 1.0 ? Pose(JAW_SIN) : sin(angle);
  float y = p.y - Pose(HINGE_Y);
  float z = p.z - Pose(HINGE_Z);
  return vec3(p.x + sqrt(weight) * Pose(JAW_SWAY), Pose(HINGE_Y) + y * c - z * s,
              Pose(HINGE_Z) + z * c + y * s + weight * Pose(JAW_SLIDE));
}
vec3 IntoJaw(vec3 p) {
  float c = Pose(JAW_COS);
  float s = Pose(JAW_SIN);
  float y = p.y - Pose(HINGE_Y);
  float z = p.z - Pose(HINGE_Z) - Pose(JAW_SLIDE);
  return vec3(p.x - Pose(JAW_SWAY), Pose(HINGE_Y) + y * c + z * s, Pose(HINGE_Z) + z * c - y * s);
}

uint Eye(uint side) { return side == 0u ? RIGHT_EYE : LEFT_EYE; }

float ArchAt(uint arch, float x) {
  float off = x - Pose(arch + MIDDLE_X);
  float t = (off / Pose(arch + HALF_WIDTH)) * (off / Pose(arch + HALF_WIDTH));
  return Pose(arch + FRONT_Z) + Pose(arch + TURN) * off -
         Pose(arch + DEPTH) * t * (kArchSquare + kArchFourth * t);
}

#ifdef STEP_begin  // item: a vertex; PlaceRecord
void Take(uint item) {
  SetPosition(item, Place(RECORD * item));
  SetNormal(item, Place(RECORD * item + 3u));
}
#endif

#ifdef STEP_channels  // ListRecord, ChannelEntry
void Take(uint item) {
  uint vertex = items[RECORD * item];
  vec3 p = Position(vertex);
  for (uint i = items[RECORD * item + 1u]; i < items[RECORD * item + 2u]; i += ENTRY) {
    p += Pose(STRENGTHS + items[i]) * Place(i + 1u);
  }
  SetPosition(vertex, p);
}
#endif

#ifdef STEP_lids  // LidRecord
struct Lid {
  uint vertex, side;
  float upper, lower, upper_angle, lower_angle, meet_angle, opening, y, z;
  bool proper;
};
Lid LidOf(uint r) {
  return Lid(items[r], items[r + 1u], Number(r + 2u), Number(r + 3u), Number(r + 4u), Number(r + 5u),
             Number(r + 6u), Number(r + 7u), Number(r + 8u), Number(r + 9u), items[r + 10u] != 0u);
}
float TurnOf(Lid lid, uint eye) {
  float lower_mm = Pose(eye + LOWER_LID_RAISED);
  float upper = lid.upper_angle + lid.opening * Pose(eye + UPPER_LID_OPEN) / kLidRadius;
  float raised = lower_mm * (lower_mm > 0.0 ? sqrt(lid.opening) : lid.opening);
  float lower = lid.lower_angle + (lid.opening * Pose(eye + LOWER_LID_OPEN) + raised) / kLidRadius;
  if (upper < lower) upper = lower = 0.5 * (upper + lower);
  upper += Pose(eye + LIDS_CLOSE) * (lid.meet_angle - upper);
  lower += Pose(eye + LIDS_CLOSE) * (lid.meet_angle - lower);
  return lid.upper * (upper - lid.upper_angle) + lid.lower * (lower - lid.lower_angle);
}
void Take(uint item) {
  Lid lid = LidOf(RECORD * item);
  uint eye = Eye(lid.side);
  float size = Pose(eye + EYE_SIZE);
  vec3 p = Position(lid.vertex);
  float turn = TurnOf(lid, eye);
  if (turn != 0.0) {
    float c = cos(turn);
    float s = sin(turn);
    vec3 d = vec3(0.0, lid.y * c + lid.z * s - lid.y, lid.z * c - lid.y * s - lid.z);
    p += vec3(-Pose(eye + EYE_SIN) * d.y, Pose(eye + EYE_COS) * d.y, size * d.z);
  }
  if (lid.proper) {
    vec3 middle = Pose3(eye + CORNEA);
    vec3 off = p - middle;
    float distance = length(off);
    float least = size * (kCorneaRadius + kLidThickness);
    if (distance < least && distance > 1.0) p = middle + off * (least / distance);
  }
  SetPosition(lid.vertex, p);
}
#endif

#ifdef STEP_lids_on_balls  // BallLidRecord
void Take(uint item) {
  uint vertex = items[RECORD * item];
  vec3 p = Position(vertex);
  vec3 off = p - Pose3(Eye(items[RECORD * item + 1u]) + BALL_CENTRE);
  float far = length(off);
  float least = Number(RECORD * item + 2u);
  if (far < least && far > 1.0) SetPosition(vertex, p + off * (least / far - 1.0));
}
#endif

#ifdef STEP_jaw  // JawRecord
void Take(uint item) {
  uint vertex = items[RECORD * item];
  SetPosition(vertex, TurnJaw(Position(vertex), Number(RECORD * item + 1u)));
}
#endif

#ifdef STEP_jaw_by_chin  // ChinRecord, one
void Take(uint item) {
  vec3 before = Place(1u);
  vec3 after = Position(items[0]) - vec3(0.0, Pose(HINGE_Y), Pose(HINGE_Z));
  float angle = clamp(atan(-after.y, after.z) - atan(-before.y, before.z), 0.0, kMostOpen);
  SetPose(JAW_ANGLE, angle);
  SetPose(JAW_SLIDE, 0.0);
  SetPose(JAW_SWAY, after.x - before.x);
  SetPose(JAW_COS, cos(angle));
  SetPose(JAW_SIN, sin(angle));
}
#endif

#ifdef STEP_teeth  // ContactRecord
float Beside(uint arch, float y) {
  float down = Pose(arch + ROOT_Y) > Pose(arch + EDGE_Y) ? 1.0 : -1.0;
  return SmoothStep(kPastTeeth, kBesideTeeth, down * (y - Pose(arch + EDGE_Y)));
}
void Take(uint item) {
  uint vertex = items[RECORD * item];
  vec3 p = Position(vertex);
  float upper = ArchAt(UPPER_ARCH, p.x) + Number(RECORD * item + 1u) - p.z;
  if (upper > 0.0) p.z += upper * Beside(UPPER_ARCH, p.y);
  vec3 q = IntoJaw(p);
  float lower = ArchAt(LOWER_ARCH, q.x) + Number(RECORD * item + 2u) - q.z;
  if (lower > 0.0) {
    q.z += lower * Beside(LOWER_ARCH, q.y);
    p = TurnJaw(q, 1.0);
  }
  SetPosition(vertex, p);
}
#endif

#ifdef STEP_lip_gaps  // GapRecord
void Take(uint item) {
  uint r = RECORD * item;
  float seal = Pose(SEAL);
  vec3 apart = Position(items[r]) - Position(items[r + 1u]) - Place(r + 2u);
  vec3 by = seal * apart;
  by.y += (1.0 - seal) * min(apart.y, 0.0);
  SetPose(seam_at + 3u * item, by.x);
  SetPose(seam_at + 3u * item + 1u, by.y);
  SetPose(seam_at + 3u * item + 2u, by.z);
}
#endif

#ifdef STEP_lips  // ListRecord, LipEntry
void Take(uint item) {
  uint vertex = items[RECORD * item];
  vec3 p = Position(vertex);
  for (uint i = items[RECORD * item + 1u]; i < items[RECORD * item + 2u]; i += ENTRY) {
    p -= Number(i + 1u) * Pose3(seam_at + 3u * items[i]);
  }
  SetPosition(vertex, p);
}
#endif

#ifdef STEP_own_form  // item: a vertex; by how much it goes, one vec3
void Take(uint item) { SetPosition(item, Position(item) + Place(RECORD * item)); }
#endif

#ifdef STEP_tongue  // TongueRecord; behind the records how many pairs the seam has, and SeamEntry
// As in tongue_path.cc and Rig::MoveTongue.
uint Seam() { return RECORD * item_count; }
vec3 High(uint k) { return Position(items[Seam() + 1u + ENTRY * k]); }
vec3 Low(uint k) { return Position(items[Seam() + 2u + ENTRY * k]); }
void LipsAt(float x, out vec3 high, out vec3 low) {
  uint count = items[Seam()];
  uint right = 0u;
  while (right < count && High(right).x < x) ++right;
  uint b = min(right, count - 1u);
  uint a = right == 0u ? 0u : right - 1u;
  float t = a == b ? 0.0 : (x - High(a).x) / max(High(b).x - High(a).x, 1e-3);
  high = mix(High(a), High(b), t);
  low = mix(Low(a), Low(b), t);
}
float Held(float p, float z) {
  return SmoothStep(z - kTongueFree, z - kTongueHeld, p) * SmoothStep(z + kTongueFree, z + kTongueHeld, p);
}
void Take(uint item) {
  uint r = RECORD * item;
  vec3 rest = Place(r + 1u);
  float tip = Number(r + 7u);
  float raise = Pose(TONGUE_RAISE);
  uint count = items[Seam()];
  vec3 edge = TurnJaw(vec3(0.0, Pose(LOWER_ARCH + EDGE_Y), Pose(LOWER_ARCH + FRONT_Z)), 1.0);
  float teeth_low = edge.y;
  float teeth_high = Pose(UPPER_ARCH + EDGE_Y);
  float front_z = max(Pose(UPPER_ARCH + FRONT_Z), edge.z);
  float room = 0.0;
  float open_from = 0.0;
  float open_to = 0.0;
  for (uint k = 0u; k < count; ++k) {
    vec3 high = High(k);
    float low = Low(k).y;
    float gap = high.y - low;
    room = max(room, min(gap, min(high.y - teeth_low, teeth_high - low)));
    if (gap <= kTongueNoRoom) continue;
    open_from = min(open_from, high.x);
    open_to = max(open_to, high.x);
  }
  float share = SmoothStep(kTongueNoRoom, kTongueRoom, min(room, teeth_high - teeth_low));
  vec3 turned = rest + vec3(0.0, raise * kTongueRaise * tip * tip, share * Pose(TONGUE_OUT) * tip);
  vec3 p = TurnJaw(turned, 1.0 - kTongueOffJaw * raise * tip);
  SetNormal(items[r], normalize(TurnJaw(rest + Place(r + 4u), 1.0) - TurnJaw(rest, 1.0)));
  if (count > 0u) {
    float jaw_x = p.x - Pose(JAW_SWAY);
    float lower_z = TurnJaw(vec3(jaw_x, Pose(LOWER_ARCH + EDGE_Y), ArchAt(LOWER_ARCH, jaw_x)), 1.0).z;
    vec3 within = vec3(p.xy, min(p.z, min(lower_z, ArchAt(UPPER_ARCH, p.x)) - kBehindTeeth));
    float outside = SmoothStep(0.0, kTongueOut, share * Pose(TONGUE_OUT));
    if (outside > 0.0) {
      float middle_x = 0.5 * (open_from + open_to);
      float width = min(kTongueInArch, kTongueInLips * (open_to - open_from)) / kTongueWidest;
      p.x += SmoothStep(front_z - kTongueWide, front_z - kTongueNarrow, p.z) *
             (middle_x + min(1.0, width) * p.x - p.x);
      vec3 high, low;
      LipsAt(p.x, high, low);
      p.y += Held(p.z, lower_z) * max(0.0, teeth_low + kTongueEdges - p.y);
      float upper_z = ArchAt(UPPER_ARCH, p.x);
      p.y += Held(p.z, upper_z) * min(0.0, teeth_high - kTongueEdges - p.y);
      float middle_y = 0.5 * (low.y + high.y);
      p.y += Held(p.z, low.z) * max(0.0, min(low.y + kTongueSkin, middle_y) - p.y);
      p.y += Held(p.z, high.z) * min(0.0, max(high.y - kTongueSkin, middle_y) - p.y);
    }
    p = mix(within, p, max(outside, 0.0));
  }
  SetPosition(items[r], p);
}
#endif

#ifdef STEP_bones  // BoneRecord; bone: 0 the jaw, 1 the right eye, 2 the left eye
void Take(uint item) {
  uint vertex = items[RECORD * item];
  uint bone = items[RECORD * item + 1u];
  vec3 p = Position(vertex);
  vec3 n = Normal(vertex);
  if (bone == 0u) {
    vec3 tip = TurnJaw(p + n, 1.0);
    p = TurnJaw(p, 1.0);
    n = normalize(tip - p);
  } else {
    uint eye = Eye(bone - 1u);
    mat3 turn = PoseMatrix(eye + EYE_TURN);
    vec3 pivot = Pose3(eye + EYE_PIVOT);
    p = pivot + turn * (p - pivot);
    n = turn * n;
  }
  SetPosition(vertex, p);
  SetNormal(vertex, n);
}
#endif

#ifdef STEP_neck  // item: a vertex; NeckRecord
void Take(uint item) {
  mat3 head = PoseMatrix(HEAD_TURN);
  vec3 p = Position(item);
  vec3 turned = kNeckPivot + head * (p - kNeckPivot) + vec3(0.0, 0.0, Pose(HEAD_FORWARD));
  SetPosition(item, p + Number(RECORD * item) * (turned - p));
  if (items[RECORD * item + 1u] != 0u) SetNormal(item, head * Normal(item));
}
#endif

#ifdef STEP_springs  // ListRecord, SpringEntry
void Take(uint item) {
  uint vertex = items[RECORD * item];
  vec3 p = Position(vertex);
  for (uint i = items[RECORD * item + 1u]; i < items[RECORD * item + 2u]; i += ENTRY) {
    p += Number(i + 1u) * Pose3(swings_at + 3u * items[i]);
  }
  SetPosition(vertex, p);
}
#endif

#ifdef STEP_normals  // ListRecord, TriangleEntry
void Take(uint item) {
  vec3 sum = vec3(0.0);
  for (uint i = items[RECORD * item + 1u]; i < items[RECORD * item + 2u]; i += ENTRY) {
    vec3 a = Position(items[i]);
    sum += cross(Position(items[i + 1u]) - a, Position(items[i + 2u]) - a);
  }
  float squared = dot(sum, sum);
  SetNormal(items[RECORD * item], squared > 1e-12 ? sum * inversesqrt(squared) : vec3(0.0, 0.0, 1.0));
}
#endif

void main() {
  if (gl_GlobalInvocationID.x < item_count) Take(gl_GlobalInvocationID.x);
}
