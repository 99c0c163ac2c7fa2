#include "fsm/render/gpu_heads.h"

#include <algorithm>

namespace fsm {

void GpuHeadRig::Move(const Head& head, std::span<const Pane> panes) {
  faces_.clear();
  for (const Pane& pane : panes) faces_.push_back({pane.state, pane.spring_offsets});
  rig_.Evaluate(head.rig(), faces_);
}

const HeadVertices& GpuHeadRig::Use(std::size_t face, HeadVertexArrays& arrays) {
  arrays.Use(rig_.positions(), rig_.normals(), rig_.OffsetBytes(face));
  partial_.Evaluate(*faces_[face].state, measured_, faces_[face].spring_offsets);
  return measured_;
}

GpuHead& GpuHeads::Acquire(const Head& head) {
  auto found = heads_.find(head.serial());
  if (found == heads_.end()) {
    if (heads_.size() >= max_) {
      heads_.erase(std::ranges::min_element(
          heads_, {}, [](const auto& entry) { return entry.second->last_use; }));
    }
    HeadVertices rest;
    head.Evaluate(FaceState{}, rest);
    found = heads_.emplace(head.serial(), std::make_unique<GpuHead>(gl_, head, rest, appearance_))
                .first;
  }
  found->second->last_use = ++use_count_;
  return *found->second;
}

void GpuHeads::Move(const Head& head, std::span<const Pane> panes) {
  GpuHead& on_gpu = Acquire(head);
  if (!on_gpu.rig)
    on_gpu.rig.emplace(gl_, rig_programs_, head, on_gpu.description.MeasuredVertices());
  on_gpu.rig->Move(head, panes);
}

}  // namespace fsm
