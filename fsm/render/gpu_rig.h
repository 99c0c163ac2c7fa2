#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "fsm/render/gl_objects.h"
#include "fsm/rig/rig.h"

namespace fsm {

struct KernelRecords;

/// The programs of shaders/rig_kernels.glsl, each compiled when a head first needs it and shared by
/// all heads of a context. Destroy while that context is current.
class RigPrograms {
 public:
  /// The bindings of buffers, which ProgramFor defines by name in the programs.
  enum Binding : GLuint {
    kPositions,
    kNormals,
    kStates,
    kStrengths,
    kSpringOffsets,
    kGaps,
    kRecords,
    kEntries
  };
  explicit RigPrograms(const GlFunctions& gl) : gl_(gl) {}
  /// Tells whether the driver has compute shaders and storage buffers (OpenGL 4.3).
  static bool Supported(const GlFunctions& gl) { return gl.has_compute; }
  /// Returns the program for such records. Throws std::runtime_error with the compiler's log.
  const GlProgram& ProgramFor(const KernelRecords& records);

 private:
  const GlFunctions& gl_;
  std::map<std::string_view, std::unique_ptr<GlProgram>> programs_;
};

/// Moves a head on a GPU by the steps of its Rig, any number of its faces in one call:
/// constant data stays in buffers on the GPU, a frame uploads a StepState for each face, and
/// positions and normals stay where they are drawn from. Agrees with Rig::Evaluate within 0.05 mm
/// (tests/fsm/render_gpu_rig_test.cc; a GPU may fuse multiply and add). Destroy while its context
/// is current.
class GpuRig {
 public:
  /// Copies from `rig`; `programs` must outlive this. REQUIRES: RigPrograms::Supported.
  GpuRig(const GlFunctions& gl, RigPrograms& programs, const Rig& rig);
  ~GpuRig();
  GpuRig(const GpuRig&) = delete;
  GpuRig& operator=(const GpuRig&) = delete;

  struct Input {
    const FaceState* state;  ///< borrowed for the call
    std::span<const glm::vec3> spring_offsets = {};
  };
  /// REQUIRES: `rig` is the one given to the constructor.
  void Evaluate(const Rig& rig, std::span<const Input> faces);
  /// The buffers of all faces' positions and normals (three floats each); a face's offset in them.
  GLuint positions() const { return buffers_[kPositions]; }
  GLuint normals() const { return buffers_[kNormals]; }
  std::size_t OffsetBytes(std::size_t face) const {
    return face * vertex_count_ * sizeof(glm::vec3);
  }

 private:
  using enum RigPrograms::Binding;
  static constexpr GLuint kBuffers = kRecords;  // beside those of the kernels
  struct Kernel {
    const GlProgram* program;
    std::array<GLuint, 2> buffers;  // kRecords and kEntries
    std::uint32_t count;
  };
  void Add(const KernelRecords& records);
  /// Makes a buffer with the bytes of `values`; at least one byte, as drivers require.
  template <typename T>
  void Fill(GLuint buffer, const std::vector<T>& values, GLenum usage) const;

  const GlFunctions& gl_;
  RigPrograms& programs_;
  const std::size_t vertex_count_, channel_count_, spring_count_, seam_count_;
  std::vector<Kernel> kernels_;  // in the order of the steps
  std::array<GLuint, kBuffers> buffers_{};
  std::size_t room_ = 0;  // number of faces that the buffers hold
};

}  // namespace fsm
