#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fsm/render/gpu_rig.h"
#include "fsm/render/head_buffers.h"
#include "fsm/render/head_textures.h"
#include "fsm/render/renderer.h"
#include "fsm/rig/partial_rig.h"

namespace fsm {

/// A head that a GPU moves. The vertices that the frame needs to know are computed on the
/// processor as well, which is faster than reading them back.
class GpuHeadRig {
 public:
  /// `measured`: indices of those vertices.
  GpuHeadRig(const GlFunctions& gl, RigPrograms& programs, const Head& head,
             std::vector<std::uint32_t> measured)
      : rig_(gl, programs, head.rig()), partial_(head.rig(), std::move(measured)) {}
  void Move(const Head& head, std::span<const Renderer::Pane> panes);
  /// Binds `buffers` to one of the faces moved last; returns the positions that are measured.
  const HeadVertices& Use(std::size_t face, HeadBuffers& buffers);

 private:
  GpuRig rig_;
  PartialRig partial_;
  std::vector<GpuRig::Input> faces_;  // those moved last
  HeadVertices measured_;
};

/// What the GPU holds for one head.
struct GpuHead {
  GpuHead(const GlFunctions& gl, const Head& head, const Appearance& appearance)
      : buffers(gl, head, appearance), textures(gl, head.surface()) {}
  HeadBuffers buffers;
  HeadTextures textures;
  std::optional<GpuHeadRig> rig;  ///< once GpuHeads::Move was called for it
  std::uint64_t drawn = 0;        ///< number of the last frame that showed it
};

/// The heads drawn last. Destroy while its context is current.
class GpuHeads {
 public:
  /// Keeps at most `most` heads; the next replaces the one that has not been drawn for the longest
  /// time. `gl` and `appearance` must outlive it.
  GpuHeads(const GlFunctions& gl, const Appearance& appearance, std::size_t max)
      : gl_(gl), appearance_(appearance), max_(max), rig_programs_(gl) {}
  /// Returns a head for a frame, uploaded if it is new. Valid until the next call.
  GpuHead& Find(const Head& head);
  /// Moves faces of a head on the GPU, for GpuHead::rig. REQUIRES: RigPrograms::Supported.
  void Move(const Head& head, std::span<const Renderer::Pane> panes);

 private:
  const GlFunctions& gl_;
  const Appearance& appearance_;
  const std::size_t max_;
  RigPrograms rig_programs_;
  std::map<std::uint64_t, std::unique_ptr<GpuHead>> heads_;  // by Head::serial
  std::uint64_t frames_ = 0;
};

}  // namespace fsm
