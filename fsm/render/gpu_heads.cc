#include "fsm/render/gpu_heads.h"

#include <algorithm>

namespace fsm {

void GpuHeadRig::Move(const Head& head, std::span<const Renderer::Pane> panes) {
  faces_.clear();
  for (const Renderer::Pane& pane : panes) faces_.push_back({pane.state, pane.spring_offsets});
  rig_.Evaluate(head.rig(), faces_);
}

const HeadVertices& GpuHeadRig::Use(std::size_t face, HeadBuffers& buffers) {
  buffers.Use(rig_.positions(), rig_.normals(), rig_.OffsetBytes(face));
  partial_.Evaluate(*faces_[face].state, measured_, faces_[face].spring_offsets);
  return measured_;
}

GpuHead& GpuHeads::Find(const Head& head) {
  auto found = heads_.find(head.serial());
  if (found == heads_.end()) {
    if (heads_.size() >= max_) {
      heads_.erase(std::ranges::min_element(heads_, {},
                                            [](const auto& entry) { return entry.second->drawn; }));
    }
    found = heads_.emplace(head.serial(), std::make_unique<GpuHead>(gl_, head, appearance_)).first;
  }
  found->second->drawn = ++frames_;
  return *found->second;
}

void GpuHeads::Move(const Head& head, std::span<const Renderer::Pane> panes) {
  GpuHead& on_gpu = Find(head);
  if (!on_gpu.rig)
    on_gpu.rig.emplace(gl_, rig_programs_, head, on_gpu.buffers.measures().Vertices());
  on_gpu.rig->Move(head, panes);
}

}  // namespace fsm
