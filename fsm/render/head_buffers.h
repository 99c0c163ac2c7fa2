#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "fsm/head/head.h"
#include "fsm/render/eye_frame.h"
#include "fsm/render/gl_functions.h"
#include "fsm/render/shadow_frame.h"

namespace fsm {

/// One head on the GL side: what never changes is uploaded once, vertices every frame.
/// Destroy while its context is current.
class HeadBuffers {
 public:
  explicit HeadBuffers(const GlFunctions& gl);
  ~HeadBuffers();
  HeadBuffers(const HeadBuffers&) = delete;
  HeadBuffers& operator=(const HeadBuffers&) = delete;

  /// Binds the head's vertex array with these vertices in it. Heads are told apart by address and
  /// by a checksum of their topology, so that one made where another died is noticed.
  void Upload(const Head& head, const HeadVertices& vertices);
  const EyeFinder& eyes() const { return eyes_; }
  const ShadowFinder& shadows() const { return shadows_; }
  /// Highest point of the hair (of the whole head if it has none), at rest: where strands begin.
  glm::vec3 crown() const { return crown_; }

 private:
  void UploadTopology(const Head& head);

  const GlFunctions& gl_;
  GLuint array_ = 0;
  GLuint buffers_[5] = {};  // position, normal, rest position, colour and occlusion, indices
  const Head* head_ = nullptr;
  std::uint64_t checksum_ = 0;
  EyeFinder eyes_;
  ShadowFinder shadows_;
  glm::vec3 crown_{0.0F};
};

/// FNV-1a over 8 bytes at a time; to notice a change, not to resist one made on purpose.
std::uint64_t Checksum(const void* data, std::size_t bytes, std::uint64_t start);

}  // namespace fsm
