// The steps of a rig (RigStep) on a GPU, one program for each. gpu_rig.cc prepends the version, the name of
// the step, RigPrograms::Binding and fsm/rig/steps.glsl, which has the arithmetic. One invocation moves one vertex of one
// face. `records` holds a step's data about its vertices. If several things act on a vertex, its record gives the
// range of `entries` that lists them.
layout(local_size_x = 64) in;
layout(std430, binding = kPositions) buffer Positions { Point positions[]; };
layout(std430, binding = kNormals) buffer Normals { Point normals[]; };
layout(std430, binding = kStates) buffer States { StepState states[]; };  // by face
layout(std430, binding = kStrengths) readonly buffer Strengths { float strengths[]; };
layout(std430, binding = kSpringOffsets) readonly buffer SpringOffsets { Point spring_offsets[]; };
layout(std430, binding = kGaps) buffer Gaps { Point gaps[]; };  // of the lips, for STEP_lips
#define RECORDS(Type) layout(std430, binding = kRecords) readonly buffer Records { Type records[]; }
#define ENTRIES(Type) layout(std430, binding = kEntries) readonly buffer Entries { Type entries[]; }
// Sizes of one head, and so the stride of a face in the buffers above.
uniform int vertex_count, channel_count, spring_count, seam_count;

uint Face() { return gl_GlobalInvocationID.y; }
uint OfFace(uint vertex) { return Face() * uint(vertex_count) + vertex; }
vec3 Position(uint vertex) { return Vec(positions[OfFace(vertex)]); }
void SetPosition(uint vertex, vec3 p) { positions[OfFace(vertex)] = PointAt(p); }
vec3 Normal(uint vertex) { return Vec(normals[OfFace(vertex)]); }
void SetNormal(uint vertex, vec3 n) { normals[OfFace(vertex)] = PointAt(n); }

#ifdef STEP_begin  // one record for each vertex
RECORDS(RestRecord);
void Apply(uint vertex) {
  SetPosition(vertex, Vec(records[vertex].position));
  SetNormal(vertex, Vec(records[vertex].normal));
}
#endif

#ifdef STEP_channels
RECORDS(ListRecord);
ENTRIES(ChannelEntry);
void Apply(uint record) {
  ListRecord list = records[record];
  vec3 p = Position(list.vertex);
  for (uint i = list.from; i < list.to; ++i)
    p += strengths[Face() * uint(channel_count) + entries[i].channel] * Vec(entries[i].offset);
  SetPosition(list.vertex, p);
}
#endif

#ifdef STEP_lids
RECORDS(LidRecord);
void Apply(uint record) {
  LidRecord lid = records[record];
  Eye eye = states[Face()].eyes[lid.side];
  vec3 p = WithLids(lid.point, eye, Position(lid.vertex));
  SetPosition(lid.vertex, lid.is_lid != 0u ? OverCornea(eye, p) : p);
}
#endif

#ifdef STEP_lids_on_balls
RECORDS(BallLidRecord);
void Apply(uint record) {
  BallLidRecord lid = records[record];
  vec3 ball = Vec(states[Face()].eyes[lid.side].ball);
  SetPosition(lid.vertex, OutOfBall(ball, lid.min_radius, Position(lid.vertex)));
}
#endif

#ifdef STEP_jaw
RECORDS(JawRecord);
void Apply(uint record) {
  JawRecord skin = records[record];
  SetPosition(skin.vertex, WithJaw(states[Face()].mouth.jaw, Position(skin.vertex), skin.weight));
}
#endif

#ifdef STEP_jaw_by_chin  // one record
RECORDS(ChinRecord);
void Apply(uint record) {
  ChinRecord chin = records[record];
  states[Face()].mouth.jaw = JawByChin(states[Face()].mouth.jaw, Vec(chin.rest), Position(chin.vertex));
}
#endif

#ifdef STEP_teeth
RECORDS(ContactRecord);
void Apply(uint record) {
  ContactRecord lip = records[record];
  vec3 p = Position(lip.vertex);
  SetPosition(lip.vertex, OffTeeth(states[Face()].mouth, p, lip.upper_gap, lip.lower_gap));
}
#endif

#ifdef STEP_lip_gaps  // comes before STEP_lips
RECORDS(GapRecord);
void Apply(uint record) {
  GapRecord pair = records[record];
  gaps[Face() * uint(seam_count) + record] =
      PointAt(LipGap(states[Face()].mouth.seal, Position(pair.upper), Position(pair.lower),
                     Vec(pair.apart_at_rest)));
}
#endif

#ifdef STEP_lips
RECORDS(ListRecord);
ENTRIES(LipEntry);
void Apply(uint record) {
  ListRecord list = records[record];
  vec3 p = Position(list.vertex);
  for (uint i = list.from; i < list.to; ++i)
    p -= entries[i].share * Vec(gaps[Face() * uint(seam_count) + entries[i].pair]);
  SetPosition(list.vertex, p);
}
#endif

#ifdef STEP_own_form  // one record for each vertex
RECORDS(Point);
void Apply(uint vertex) { SetPosition(vertex, Position(vertex) + Vec(records[vertex])); }
#endif

#ifdef STEP_tongue  // entries: the pairs of the lips, from -x to +x
RECORDS(TongueRecord);
ENTRIES(SeamEntry);
LipPair Lips(uint k) { return LipPair(Position(entries[k].upper), Position(entries[k].lower)); }
LipPair LipsAt(float x) {
  uint last = uint(seam_count) - 1u;
  uint right = 0u;
  while (right <= last && Position(entries[right].upper).x < x) ++right;
  return LipsBetween(Lips(right == 0u ? 0u : right - 1u), Lips(min(right, last)), x);
}
void Apply(uint record) {
  TongueRecord tongue = records[record];
  Mouth mouth = states[Face()].mouth;
  TonguePath path = PathPastTeeth(mouth);
  for (uint k = 0u; k < uint(seam_count); ++k) path = LipsOnPath(path, Lips(k));
  float out_mm = TongueProtrusion(path, mouth);
  SetNormal(tongue.vertex, NormalWithJaw(mouth.jaw, Vec(tongue.rest), Vec(tongue.rest_normal)));
  vec3 p = RaisedTongue(mouth, out_mm, Vec(tongue.rest), tongue.tip);
  if (seam_count > 0) {
    p = out_mm > 0.0 ? TongueOverTeeth(path, mouth, out_mm, p, LipsAt(NarrowTongue(path, p).x))
                     : BehindTeeth(mouth, p);
  }
  SetPosition(tongue.vertex, p);
}
#endif

#ifdef STEP_bones
RECORDS(BoneRecord);
void Apply(uint record) {
  uint vertex = records[record].vertex;
  uint bone = records[record].bone;
  vec3 p = Position(vertex);
  vec3 n = Normal(vertex);
  if (bone == kJawBone) {
    Jaw jaw = states[Face()].mouth.jaw;
    SetNormal(vertex, NormalWithJaw(jaw, p, n));
    SetPosition(vertex, WithJaw(jaw, p, 1.0));
  } else {
    Eye eye = states[Face()].eyes[bone];
    SetNormal(vertex, Rotated(eye.gaze, n));
    SetPosition(vertex, WithGaze(eye, p));
  }
}
#endif

#ifdef STEP_neck  // one record for each vertex
RECORDS(NeckRecord);
void Apply(uint vertex) {
  Neck neck = states[Face()].neck;
  SetPosition(vertex, WithNeck(neck, Position(vertex), records[vertex].weight));
  if (records[vertex].turns_normal != 0u) SetNormal(vertex, Rotated(neck.rotation, Normal(vertex)));
}
#endif

#ifdef STEP_springs
RECORDS(ListRecord);
ENTRIES(SpringEntry);
void Apply(uint record) {
  ListRecord list = records[record];
  vec3 p = Position(list.vertex);
  for (uint i = list.from; i < list.to; ++i)
    p += entries[i].weight * Vec(spring_offsets[Face() * uint(spring_count) + entries[i].spring]);
  SetPosition(list.vertex, p);
}
#endif

#ifdef STEP_normals
RECORDS(ListRecord);
ENTRIES(TriangleEntry);
void Apply(uint record) {
  ListRecord list = records[record];
  vec3 sum = vec3(0.0);
  for (uint i = list.from; i < list.to; ++i)
    sum += TriangleNormal(Position(entries[i].a), Position(entries[i].b), Position(entries[i].c));
  SetNormal(list.vertex, UnitNormal(sum));
}
#endif

void main() {
  if (gl_GlobalInvocationID.x < uint(records.length())) Apply(gl_GlobalInvocationID.x);
}
