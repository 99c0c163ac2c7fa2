#include "fsm/render/card_heads.h"

#include <algorithm>

namespace fsm {

void CardRig::Move(const Head& head, std::span<const Renderer::Pane> panes) {
  faces_.clear();
  for (const Renderer::Pane& pane : panes) faces_.push_back({pane.state, pane.spring_offsets});
  rig_.Evaluate(head.rig(), faces_);
}

const HeadVertices& CardRig::Use(std::size_t face, HeadBuffers& buffers) {
  buffers.Use(rig_.positions(), rig_.normals(), rig_.OffsetBytes(face));
  partial_.Evaluate(*faces_[face].state, measured_, faces_[face].spring_offsets);
  return measured_;
}

CardHead& CardHeads::Find(const Head& head) {
  auto found = heads_.find(head.serial());
  if (found == heads_.end()) {
    if (heads_.size() >= most_) {
      heads_.erase(std::ranges::min_element(heads_, {},
                                            [](const auto& entry) { return entry.second->drawn; }));
    }
    found = heads_.emplace(head.serial(), std::make_unique<CardHead>(gl_, head, appearance_)).first;
  }
  found->second->drawn = ++frames_;
  return *found->second;
}

void CardHeads::Move(const Head& head, std::span<const Renderer::Pane> panes) {
  CardHead& on_card = Find(head);
  if (!on_card.rig)
    on_card.rig.emplace(gl_, rig_programs_, head, on_card.buffers.MeasuredVertices());
  on_card.rig->Move(head, panes);
}

}  // namespace fsm
