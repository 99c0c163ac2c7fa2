#include "fsm/render/gpu_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

#include "embedded/rig_kernels.h"
#include "embedded/rig_steps.h"
#include "fsm/rig/rig_records.h"

namespace fsm {

const GlProgram& RigPrograms::ProgramFor(const KernelRecords& records) {
  auto& program = programs_[records.kernel];
  if (!program) {
    const std::string source =
        fmt::format("#version 430\n#define STEP_{}\n#define FUNCTION\n{}{}{}", records.kernel,
                    ShaderNumbers<Binding>(), embedded::rig_steps(), embedded::rig_kernels());
    program = std::make_unique<GlProgram>(gl_, records.kernel, source);
  }
  return *program;
}

GpuRig::GpuRig(const GlFunctions& gl, RigPrograms& programs, const Rig& rig)
    : gl_(gl),
      programs_(programs),
      vertex_count_(rig.data().rest.size()),
      channel_count_(rig.data().channels.size()),
      spring_count_(rig.data().spring_rig.springs.size()),
      seam_count_(rig.data().mouth.seam.size()) {
  gl_.GenBuffers(kBuffers, buffers_.data());
  for (const KernelRecords& records : PackRig(rig.data())) Add(records);
}

GpuRig::~GpuRig() {
  gl_.DeleteBuffers(kBuffers, buffers_.data());
  for (const Kernel& kernel : kernels_) gl_.DeleteBuffers(2, kernel.buffers.data());
}

template <typename T>
void GpuRig::Fill(GLuint buffer, const std::vector<T>& values, GLenum usage) const {
  gl_.BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
  const auto bytes = std::as_bytes(std::span(values));
  if (bytes.empty()) return gl_.BufferData(GL_SHADER_STORAGE_BUFFER, 1, nullptr, usage);
  gl_.BufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(),
                 usage);
}

void GpuRig::Add(const KernelRecords& records) {
  Kernel& kernel = kernels_.emplace_back(
      Kernel{&programs_.ProgramFor(records), {}, static_cast<std::uint32_t>(records.count)});
  gl_.GenBuffers(2, kernel.buffers.data());
  Fill(kernel.buffers[0], records.records, GL_STATIC_DRAW);
  Fill(kernel.buffers[1], records.entries, GL_STATIC_DRAW);
}

void GpuRig::Evaluate(const Rig& rig, std::span<const Input> faces) {
  if (faces.empty()) return;
  RigInputs inputs;
  std::vector<step::StepState> states;
  std::vector<float> strengths;
  std::vector<glm::vec3> spring_offsets;
  for (const Input& face : faces) {
    rig.ComputeInputs(*face.state, inputs);
    states.push_back(inputs.state);
    strengths.insert(strengths.end(), inputs.strengths.begin(), inputs.strengths.end());
    assert(face.spring_offsets.empty() || face.spring_offsets.size() == spring_count_);
    spring_offsets.insert(spring_offsets.end(), face.spring_offsets.begin(),
                          face.spring_offsets.end());
    spring_offsets.resize(states.size() * spring_count_, glm::vec3(0));
  }
  Fill(buffers_[kStates], states, GL_STREAM_DRAW);
  Fill(buffers_[kStrengths], strengths, GL_STREAM_DRAW);
  Fill(buffers_[kSpringOffsets], spring_offsets, GL_STREAM_DRAW);
  if (room_ < faces.size()) {
    room_ = faces.size();
    for (const auto& [which, count] : {std::pair(kPositions, vertex_count_),
                                       {kNormals, vertex_count_},
                                       {kGaps, std::max(seam_count_, std::size_t{1})}}) {
      gl_.BindBuffer(GL_SHADER_STORAGE_BUFFER, buffers_[which]);
      gl_.BufferData(GL_SHADER_STORAGE_BUFFER,
                     static_cast<GLsizeiptr>(room_ * count * sizeof(glm::vec3)), nullptr,
                     GL_DYNAMIC_COPY);
    }
  }
  for (GLuint which = 0; which < kBuffers; ++which)
    gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, which, buffers_[which]);
  for (const Kernel& kernel : kernels_) {
    kernel.program->Use();
    kernel.program->Set("vertex_count", static_cast<GLint>(vertex_count_));
    kernel.program->Set("channel_count", static_cast<GLint>(channel_count_));
    kernel.program->Set("spring_count", static_cast<GLint>(spring_count_));
    kernel.program->Set("seam_count", static_cast<GLint>(seam_count_));
    for (GLuint k = 0; k < 2; ++k)
      gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, kRecords + k, kernel.buffers[k]);
    constexpr std::uint32_t kGroup = 64;  // local_size_x
    gl_.DispatchCompute((kernel.count + kGroup - 1) / kGroup, static_cast<GLuint>(faces.size()), 1);
    gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  }
  gl_.MemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace fsm
