#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fsm/render/gpu_rig.h"
#include "fsm/render/head_textures.h"
#include "fsm/render/head_vertex_arrays.h"
#include "fsm/render/pane.h"
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
  void Move(const Head& head, std::span<const Pane> panes);
  /// Binds `arrays` to one of the faces moved last; returns the positions that are measured.
  const HeadVertices& Use(std::size_t face, HeadVertexArrays& arrays);

 private:
  GpuRig rig_;
  PartialRig partial_;
  std::vector<GpuRig::Input> faces_;  // those moved last
  HeadVertices measured_;
};

/// What drawing keeps of one head.
struct GpuHead {
  /// `rest`: the head's vertices at rest. `gl` and `appearance` must outlive it.
  GpuHead(const GlFunctions& gl, const Head& head, const HeadVertices& rest,
          const Appearance& appearance)
      : description(head, rest, appearance),
        arrays(gl, description, rest),
        textures(gl, head.surface()) {}
  HeadDescription description;
  HeadVertexArrays arrays;
  HeadTextures textures;
  std::optional<GpuHeadRig> rig;  ///< once GpuHeads::Move was called for it
  std::uint64_t last_use = 0;     ///< GpuHeads' count of uses at the last one
};

/// The heads drawn last. Destroy while its context is current.
class GpuHeads {
 public:
  /// Keeps at most `max` heads; the next replaces the one that has not been used for the longest
  /// time. `gl` and `appearance` must outlive it.
  GpuHeads(const GlFunctions& gl, const Appearance& appearance, std::size_t max)
      : gl_(gl), appearance_(appearance), max_(max), rig_programs_(gl) {}
  /// Returns a head for a frame, uploaded if it is new. Valid until the next call.
  GpuHead& Acquire(const Head& head);
  /// Moves faces of a head on the GPU, for GpuHead::rig. REQUIRES: RigPrograms::Supported.
  void Move(const Head& head, std::span<const Pane> panes);

 private:
  const GlFunctions& gl_;
  const Appearance& appearance_;
  const std::size_t max_;
  RigPrograms rig_programs_;
  std::map<std::uint64_t, std::unique_ptr<GpuHead>> heads_;  // by Head::serial
  std::uint64_t use_count_ = 0;
};

}  // namespace fsm
