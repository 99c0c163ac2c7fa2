#include "fsm/render/gpu_rig.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <iomanip>
#include <locale>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "embedded/rig_steps.h"
#include "fsm/render/rig_items.h"
#include "fsm/rig/step_constants.h"

namespace fsm {
namespace {

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
      naming_ = side == Side::kRight;  // the members of the other eye are called the same
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
    naming_ = true;
    Begin("UPPER_ARCH");
    Add(rig.teeth.upper);
    Begin("LOWER_ARCH");
    naming_ = false;  // as those of the upper one
    Add(rig.teeth.lower);
    naming_ = true;
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
    if (constants_ == nullptr || !naming_) return;
    *constants_ += "const uint " + std::string(name) + " = " +
                   std::to_string(numbers_.size() - begin_) + "u;\n";
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
    Name(name);
    for (int c = 0; c < 3; ++c) numbers_.insert(numbers_.end(), {m[c].x, m[c].y, m[c].z});
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
  bool naming_ = true;  // whether what is added gets a name in `constants_`
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

}  // namespace

const GlProgram& RigPrograms::Of(const RigItems& items) {
  auto& program = programs_[items.step];
  if (!program) {
    static const std::string constants = [] {
      std::string text = StepConstants();
      PoseBlock({}, {}, &text);  // places depend on no rig
      return text;
    }();
    const std::string source = "#version 430\n#define STEP_" + std::string(items.step) +
                               "\nconst uint RECORD = " + std::to_string(items.record_words) +
                               "u, ENTRY = " + std::to_string(items.entry_words) + "u;\n" +
                               constants + std::string(embedded::rig_steps());
    program = std::make_unique<GlProgram>(gl_, items.step, source);
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
  for (const RigItems& items : ItemsOfSteps(rig.data())) Add(items);
}

GpuRig::~GpuRig() {
  gl_.DeleteBuffers(kBuffers, buffers_.data());
  for (const Kernel& kernel : kernels_) gl_.DeleteBuffers(1, &kernel.items);
}

void GpuRig::Add(const RigItems& items) {
  const auto count = static_cast<std::uint32_t>(items.count);
  kernels_.push_back({&programs_.Of(items), 0, count});
  gl_.GenBuffers(1, &kernels_.back().items);
  gl_.BindBuffer(GL_SHADER_STORAGE_BUFFER, kernels_.back().items);
  std::vector<std::uint32_t> words{count};
  words.insert(words.end(), items.words.begin(), items.words.end());
  gl_.BufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(words.size() * sizeof(words[0])),
                 words.data(), GL_STATIC_DRAW);
}

void GpuRig::Evaluate(const Rig& rig, std::span<const Input> faces) {
  if (faces.empty()) return;
  // First what all poses share (Poses in rig_steps.glsl), when it is known.
  constexpr std::size_t kShared = 4;
  std::vector<float> poses(kShared);
  std::size_t swings_at = 0;
  for (const Input& face : faces) {
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
