#pragma once

#include <array>
#include <vector>

#include "fsm/head/face_state.h"

namespace fsm {

/// Tells of which key mouths a mouth is mixed: the least squares with no negative part. Speech
/// blends the key shapes of its table, so these come out again; what cannot be explained by them is
/// given back.
class VisemeMix {
 public:
  using Mouth = std::array<float, kMouthParameters>;
  explicit VisemeMix(std::vector<Mouth> keys);

  struct Parts {
    std::vector<float> visemes;  ///< of each key, 0..1.5
    Mouth rest{};                ///< what they leave
  };
  Parts TakeApart(const Mouth& mouth) const;

 private:
  std::vector<Mouth> keys_;
  std::vector<std::vector<float>> products_;  // of each two keys
};

}  // namespace fsm
