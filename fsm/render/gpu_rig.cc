#include "fsm/render/gpu_rig.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <iomanip>
#include <locale>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "embedded/rig_steps.h"
#include "fsm/rig/step_constants.h"

namespace fsm {
namespace {

using Words = std::vector<std::uint32_t>;

std::uint32_t Word(float number) { return std::bit_cast<std::uint32_t>(number); }
void Put(Words& words, std::initializer_list<std::uint32_t> more) {
  words.insert(words.end(), more);
}
void Put(Words& words, glm::vec3 p) { Put(words, {Word(p.x), Word(p.y), Word(p.z)}); }

/// What acts on each vertex, as lists. Entries keep their order, so that sums are taken in the same
/// order as on the processor.
class VertexLists {
 public:
  explicit VertexLists(std::size_t vertices) : entries_(vertices) {}
  Words& operator[](std::uint32_t vertex) { return entries_[vertex]; }
  std::size_t count() const { return count_; }
  /// As the shader reads them: a record for each vertex with where its entries are, then these.
  Words Flat() {
    for (const Words& entry : entries_) count_ += entry.empty() ? 0 : 1;
    Words records, behind;
    for (std::uint32_t vertex = 0; vertex < entries_.size(); ++vertex) {
      const Words& entry = entries_[vertex];
      if (entry.empty()) continue;
      const auto from = static_cast<std::uint32_t>(3 * count_ + behind.size());
      Put(records, {vertex, from, from + static_cast<std::uint32_t>(entry.size())});
      behind.insert(behind.end(), entry.begin(), entry.end());
    }
    records.insert(records.end(), behind.begin(), behind.end());
    return records;
  }

 private:
  std::vector<Words> entries_;  // by vertex
  std::size_t count_ = 0;
};

/// A pose as the shaders read it.
class PoseBlock {
 public:
  /// `constants`, if not null, is told where members begin: "const uint JAW_ANGLE = 0u;" and so on.
  PoseBlock(const RigData& rig, const RigInputs& inputs, std::string* constants = nullptr)
      : constants_(constants) {
    const Pose& pose = inputs.pose;
    Add("JAW_ANGLE", pose.jaw.open_rad);
    Add("JAW_SLIDE", pose.jaw.slide_mm);
    Add("JAW_SWAY", pose.jaw.sway_mm);
    Add("JAW_COS", pose.jaw_cos);
    Add("JAW_SIN", pose.jaw_sin);
    Add("HINGE_Y", pose.hinge.y);
    Add("HINGE_Z", pose.hinge.z);
    Add("SEAL", pose.seal);
    Add("TONGUE_RAISE", pose.tongue_raise);
    Add("TONGUE_OUT", pose.tongue_out_mm);
    Add("HEAD_TURN", pose.head);
    Add("HEAD_FORWARD", pose.head_forward_mm);
    for (const Side side : kSides) {
      Begin(side == Side::kRight ? "RIGHT_EYE" : "LEFT_EYE");
      Add("EYE_TURN", inputs.eye_turn[side]);
      Add("EYE_PIVOT", rig.eyes.pivot[side]);
      Add("BALL_CENTRE", rig.ball_lids.centre[side]);
      const EyeTransform& eye = rig.lids.eyes[side];
      const UnitEffects::Lids& ask = pose.lids[side];
      const glm::vec3 across = eye.Turned({0, 1, 0});  // -sin, cos
      Add("EYE_COS", across.y);
      Add("EYE_SIN", -across.x);
      Add("EYE_SIZE", eye.size);
      Add("UPPER_LID_OPEN", eye.upper_mm + ask.upper_mm);
      Add("LOWER_LID_OPEN", eye.lower_mm);
      Add("LIDS_CLOSE", ask.close);
      Add("LOWER_LID_RAISED", ask.lower_mm);
      Add("CORNEA", rig.lids.ball[side] + eye.size * rig.lids.cornea_centre * pose.eye[side][2]);
    }
    Begin("UPPER_ARCH");
    Add(rig.teeth.upper);
    Begin("LOWER_ARCH");
    Add(rig.teeth.lower);
    Begin("STRENGTHS");
    numbers_.insert(numbers_.end(), inputs.strengths.begin(), inputs.strengths.end());
  }

  const std::vector<float>& numbers() const { return numbers_; }

 private:
  /// What is added from here on has places from here on; before, from the pose's beginning.
  void Begin(const char* name) {
    begin_ = 0;
    Name(name);
    begin_ = numbers_.size();
  }
  void Name(const char* name) {
    if (constants_ == nullptr) return;
    const std::string constant = "const uint " + std::string(name) + " = ";
    if (constants_->find(constant) != std::string::npos) return;  // of the other side
    *constants_ += constant + std::to_string(numbers_.size() - begin_) + "u;\n";
  }
  void Add(const char* name, float number) {
    Name(name);
    numbers_.push_back(number);
  }
  void Add(const char* name, glm::vec3 p) {
    Name(name);
    numbers_.insert(numbers_.end(), {p.x, p.y, p.z});
  }
  void Add(const char* name, const glm::mat3& m) {
    for (int column = 0; column < 3; ++column) Add(name, m[column]);
  }
  void Add(const ToothArch& arch) {
    Add("FRONT_Z", arch.front_z);
    Add("DEPTH", arch.depth);
    Add("HALF_WIDTH", arch.half_width);
    Add("EDGE_Y", arch.edge_y);
    Add("ROOT_Y", arch.root_y);
    Add("MIDDLE_X", arch.middle_x);
    Add("TURN", arch.turn);
  }

  std::string* const constants_;
  std::vector<float> numbers_;
  std::size_t begin_ = 0;
};

/// "const float kMostOpen = 0.5;" and so on.
std::string StepConstants() {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(9) << std::showpoint;
  const auto add = [&text](std::string_view name, float value) {
    text << "const float " << name << " = " << value << ";\n";
  };
  for (const step::Named& constant : step::kAll) add(constant.name, constant.value);
  add("kCorneaRadius", kCorneaRadius);
  text << "const vec3 kNeckPivot = vec3(" << kNeckPivot.x << ", " << kNeckPivot.y << ", "
       << kNeckPivot.z << ");\n";
  return text.str();
}

Words BeginItems(const RigData& data) {
  const auto& place = data.Start();
  Words items;
  for (std::size_t i = 0; i < place.size(); ++i) {
    Put(items, place[i]);
    Put(items, data.rest_normal[i]);
  }
  return items;
}

Words LidItems(const LidRig& lids) {
  Words items;
  for (const LidRig::Vertex& lid : lids.vertices) {
    Put(items, {lid.vertex, static_cast<std::uint32_t>(lid.side), Word(lid.upper), Word(lid.lower),
                Word(lid.upper_angle), Word(lid.lower_angle), Word(lid.meet_angle),
                Word(lid.opening), Word(lid.y), Word(lid.z), lid.proper ? 1u : 0u});
  }
  return items;
}

Words GapItems(const LipRig& lips) {
  Words items;
  for (std::size_t k = 0; k < lips.seam.size(); ++k) {
    Put(items, {lips.seam[k].first, lips.seam[k].second});
    Put(items, lips.apart_at_rest.empty() ? glm::vec3(0) : lips.apart_at_rest[k]);
  }
  return items;
}

Words TongueItems(const RigData& data) {
  Words items;
  for (std::uint32_t i = 0; i < data.rest.size(); ++i) {
    if (data.bone[i] != Bone::kTongue) continue;
    Put(items, {i});
    Put(items, data.rest[i]);
    Put(items, data.rest_normal[i]);
    Put(items, {Word(data.weights[i].free)});
  }
  Put(items, {static_cast<std::uint32_t>(data.lips.seam.size())});
  for (const auto& [upper, lower] : data.lips.seam) Put(items, {upper, lower});
  return items;
}

Words BoneItems(const RigData& data) {
  Words items;
  for (std::uint32_t i = 0; i < data.rest.size(); ++i) {
    if (data.bone[i] == Bone::kJaw) Put(items, {i, 0});
    if (data.bone[i] == Bone::kEyeRight) Put(items, {i, 1});
    if (data.bone[i] == Bone::kEyeLeft) Put(items, {i, 2});
  }
  return items;
}

/// A vertex gathers from all triangles about it, and about those it shares its normal with.
VertexLists NormalLists(const RigData& data) {
  const NormalRig& normals = data.normals;
  const Words& t = normals.soft_triangles;
  VertexLists lists(data.rest.size());
  for (std::size_t k = 0; k + 2 < t.size(); k += 3) {
    for (std::size_t c = 0; c < 3; ++c)
      Put(lists[normals.Owner(t[k + c])], {t[k], t[k + 1], t[k + 2]});
  }
  for (const std::uint32_t i : t) {
    if (normals.Owner(i) != i) lists[i] = lists[normals.Owner(i)];
  }
  return lists;
}

}  // namespace

const GlProgram& RigPrograms::Of(const char* kernel) {
  auto& program = programs_[kernel];
  if (!program) {
    static const std::string constants = [] {
      std::string text = StepConstants();
      PoseBlock({}, {}, &text);  // places depend on no rig
      return text;
    }();
    const std::string source = "#version 430\n#define STEP_" + std::string(kernel) + "\n" +
                               constants + std::string(embedded::rig_steps());
    program = std::make_unique<GlProgram>(gl_, kernel, source);
  }
  return *program;
}

GpuRig::GpuRig(const GlFunctions& gl, RigPrograms& programs, const Rig& rig)
    : gl_(gl),
      programs_(programs),
      vertex_count_(rig.data().rest.size()),
      spring_count_(rig.data().swing.springs.size()),
      seam_count_(rig.data().lips.seam.size()) {
  gl_.GenBuffers(kBuffers, buffers_.data());
  Add("begin", BeginItems(rig.data()), vertex_count_);
  for (const RigStep step : rig.data().steps) AddStep(step, rig.data());
}

GpuRig::~GpuRig() {
  gl_.DeleteBuffers(kBuffers, buffers_.data());
  for (const Kernel& kernel : kernels_) gl_.DeleteBuffers(1, &kernel.items);
}

void GpuRig::Add(const char* kernel, std::span<const std::uint32_t> items, std::size_t count) {
  if (count == 0) return;
  kernels_.push_back({&programs_.Of(kernel), 0, static_cast<std::uint32_t>(count)});
  gl_.GenBuffers(1, &kernels_.back().items);
  gl_.BindBuffer(GL_SHADER_STORAGE_BUFFER, kernels_.back().items);
  Words words{static_cast<std::uint32_t>(count)};
  words.insert(words.end(), items.begin(), items.end());
  gl_.BufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(words.size() * sizeof(words[0])),
                 words.data(), GL_STATIC_DRAW);
}

void GpuRig::AddStep(RigStep step, const RigData& data) {
  const auto add_lists = [this](const char* kernel, VertexLists lists) {
    const Words items = lists.Flat();
    Add(kernel, items, lists.count());
  };
  VertexLists lists(data.rest.size());
  Words items;
  switch (step) {
    case RigStep::kChannels:
      for (std::uint32_t k = 0; k < data.channels.size(); ++k) {
        for (const Displacement& move : data.channels[k].moves) {
          Put(lists[move.vertex], {k});
          Put(lists[move.vertex], move.by);
        }
      }
      return add_lists("channels", std::move(lists));
    case RigStep::kLids:
      return Add("lids", LidItems(data.lids), data.lids.vertices.size());
    case RigStep::kLidsOnBalls:
      for (const BallLids::Vertex& lid : data.ball_lids.vertices) {
        Put(items, {lid.vertex, static_cast<std::uint32_t>(lid.side), Word(lid.least)});
      }
      return Add("lids_on_balls", items, data.ball_lids.vertices.size());
    case RigStep::kJaw:
      for (std::uint32_t i = 0; i < data.rest.size(); ++i) {
        if (Rig::MovesWithJaw(data, i)) Put(items, {i, Word(data.weights[i].jaw)});
      }
      return Add("jaw", items, items.size() / 2);
    case RigStep::kJawByChin:
      Put(items, {data.jaw.chin});
      Put(items, data.rest[data.jaw.chin] - data.jaw.hinge);
      return Add("jaw_by_chin", items, 1);
    case RigStep::kTeeth:
      for (const TeethRig::Contact& contact : data.teeth.contacts)
        Put(items, {contact.vertex, Word(contact.upper_gap), Word(contact.lower_gap)});
      return Add("teeth", items, data.teeth.contacts.size());
    case RigStep::kLips:
      for (const LipRig::Follower& f : data.lips.followers)
        Put(lists[f.vertex], {f.pair, Word(LipRig::ShareOf(f))});
      Add("lip_gaps", GapItems(data.lips), data.lips.seam.size());
      return add_lists("lips", std::move(lists));
    case RigStep::kOwnForm:
      for (const glm::vec3 by : data.proxy.to_own) Put(items, by);
      return Add("own_form", items, data.proxy.to_own.size());
    case RigStep::kTongue:
      items = TongueItems(data);
      return Add("tongue", items, (items.size() - 1 - 2 * data.lips.seam.size()) / 8);
    case RigStep::kBones:
      items = BoneItems(data);
      return Add("bones", items, items.size() / 2);
    case RigStep::kNeck:
      for (std::size_t i = 0; i < data.rest.size(); ++i)
        Put(items, {Word(data.weights[i].neck), data.bone[i] != Bone::kSkin ? 1u : 0u});
      return Add("neck", items, data.rest.size());
    case RigStep::kSprings:
      for (const auto& [vertex, spring, weight] : data.swing.weights)
        Put(lists[vertex], {spring, Word(weight)});
      return add_lists("springs", std::move(lists));
    case RigStep::kNormals:
      return add_lists("normals", NormalLists(data));
  }
}

void GpuRig::Evaluate(const Rig& rig, std::span<const Face> faces) {
  if (faces.empty()) return;
  // First what all poses share (Poses in rig_steps.glsl), when it is known.
  constexpr std::size_t kShared = 4;
  std::vector<float> poses(kShared);
  std::size_t swings_at = 0;
  for (const Face& face : faces) {
    PoseBlock block(rig.data(), rig.InputsOf(*face.state));
    swings_at = block.numbers().size();
    // Zeros where nothing swings, and for the gaps of the lips, which a step fills in.
    poses.insert(poses.end(), block.numbers().begin(), block.numbers().end());
    assert(face.swings.empty() || face.swings.size() == spring_count_);
    for (std::size_t k = 0; k < spring_count_; ++k) {
      const glm::vec3 by = face.swings.empty() ? glm::vec3(0) : face.swings[k];
      poses.insert(poses.end(), {by.x, by.y, by.z});
    }
    poses.resize(poses.size() + 3 * seam_count_, 0.0F);
  }
  const std::array<std::size_t, kShared> shared{vertex_count_,
                                                (poses.size() - kShared) / faces.size(), swings_at,
                                                swings_at + 3 * spring_count_};
  std::ranges::transform(shared, poses.begin(), [](std::size_t number) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(number));
  });
  const auto bind = [this](Buffer which) {
    gl_.BindBuffer(GL_SHADER_STORAGE_BUFFER, buffers_[which]);
  };
  if (room_ < faces.size()) {
    room_ = faces.size();
    for (const Buffer which : {kPositions, kNormals}) {
      bind(which);
      gl_.BufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(OffsetBytes(room_)), nullptr,
                     GL_DYNAMIC_COPY);
    }
  }
  bind(kPoses);
  gl_.BufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(poses.size() * sizeof(float)),
                 poses.data(), GL_STREAM_DRAW);
  for (const Buffer which : {kPositions, kNormals, kPoses})
    gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, which, buffers_[which]);
  for (const Kernel& kernel : kernels_) {
    kernel.program->Use();
    gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, kBuffers, kernel.items);
    constexpr std::uint32_t kGroup = 64;  // local_size_x
    gl_.DispatchCompute((kernel.count + kGroup - 1) / kGroup, static_cast<GLuint>(faces.size()), 1);
    gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  }
  gl_.MemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void GpuRig::Read(std::size_t face, HeadVertices& out) const {
  const auto read = [&](Buffer which, std::vector<glm::vec3>& into) {
    into.resize(vertex_count_);
    gl_.BindBuffer(GL_SHADER_STORAGE_BUFFER, buffers_[which]);
    gl_.GetBufferSubData(GL_SHADER_STORAGE_BUFFER, static_cast<GLintptr>(OffsetBytes(face)),
                         static_cast<GLsizeiptr>(OffsetBytes(1)), into.data());
  };
  read(kPositions, out.position);
  read(kNormals, out.normal);
}

}  // namespace fsm
