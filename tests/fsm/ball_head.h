#pragma once

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "fsm/rig/head.h"
#include "tests/support/still_rig.h"

/// A head for tests of drawing alone: an ellipsoid of skin with two eyeballs, a patch of hair and
/// shoulders, of roughly human size. Nothing in it moves.
class BallHead : public fsm::Head {
 public:
  explicit BallHead(glm::vec3 skin = {0.62F, 0.36F, 0.26F},
                    const std::function<void(fsm::HeadAsset&)>& change = {})
      : Head(Maker(skin, change).asset) {}
  explicit BallHead(const std::function<void(fsm::HeadAsset&)>& change)
      : BallHead({0.62F, 0.36F, 0.26F}, change) {}

 private:
  struct Maker {
    Maker(glm::vec3 skin, const std::function<void(fsm::HeadAsset&)>& change) {
      Ellipsoid(fsm::Material::kSkin, {0, 0, 10}, {75, 110, 95}, skin);
      Ellipsoid(fsm::Material::kHair, {0, 14, -6}, {80, 108, 90}, {0.06F, 0.035F, 0.02F});
      Ellipsoid(fsm::Material::kCloth, {0, -190, -10}, {190, 80, 80}, {0.05F, 0.07F, 0.12F});
      for (const float x : {-32.0F, 32.0F}) {
        Ellipsoid(fsm::Material::kSclera, {x, 20, 92}, {12, 12, 12}, {0.75F, 0.72F, 0.70F});
        Ellipsoid(fsm::Material::kIris, {x, 20, 103}, {5.8F, 5.8F, 2}, {0.10F, 0.16F, 0.20F});
      }
      asset.rig = support::MakeStillRig(std::move(position), std::move(normal));
      if (change) change(asset);
    }

    static constexpr std::uint32_t kRows = 24;
    static constexpr std::uint32_t kColumns = 48;

    void Ellipsoid(fsm::Material material, glm::vec3 centre, glm::vec3 radius, glm::vec3 albedo) {
      const auto base = static_cast<std::uint32_t>(position.size());
      const auto first = static_cast<std::uint32_t>(asset.surface.indices.size());
      constexpr float kPi = std::numbers::pi_v<float>;
      for (std::uint32_t row = 0; row <= kRows; ++row) {
        const float up = kPi * (0.5F - static_cast<float>(row) / kRows);
        for (std::uint32_t column = 0; column <= kColumns; ++column) {
          const float around = 2 * kPi * static_cast<float>(column) / kColumns;
          const glm::vec3 unit{std::cos(up) * std::sin(around), std::sin(up),
                               std::cos(up) * std::cos(around)};
          position.push_back(centre + radius * unit);
          normal.push_back(glm::normalize(unit / radius));
          asset.surface.albedo.push_back(albedo);
          asset.surface.openness.push_back(1);
        }
      }
      for (std::uint32_t row = 0; row < kRows; ++row) {
        for (std::uint32_t column = 0; column < kColumns; ++column) {
          const std::uint32_t a = base + row * (kColumns + 1) + column;
          const std::uint32_t b = a + kColumns + 1;
          for (const auto i : {a, b, b + 1, a, b + 1, a + 1}) asset.surface.indices.push_back(i);
        }
      }
      asset.surface.parts.push_back(
          {material, first, static_cast<std::uint32_t>(asset.surface.indices.size()) - first});
    }

    fsm::HeadAsset asset;
    std::vector<glm::vec3> position, normal;
  };
};
