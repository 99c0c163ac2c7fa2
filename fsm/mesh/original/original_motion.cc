#include "fsm/mesh/original/original_motion.h"

#include <algorithm>
#include <cstddef>
#include <glm/geometric.hpp>

#include "fsm/mesh/original/lip_seal.h"
#include "fsm/mesh/original/original_expressions.h"
#include "fsm/mesh/original/original_points.h"
#include "fsm/mesh/rig_unrigged_head.h"
#include "fsm/mesh/transfer/drive_fit.h"
#include "fsm/mesh/transfer/nnls_solver.h"
#include "fsm/rig/unit_effects.h"

namespace fsm {
namespace {

/// The factor on a viseme's offsets at full articulation. The original applies the whole offsets at
/// a MouthScale of 100; its default of 30 is three quarters of full articulation here.
constexpr float kVisemeShare = 0.4f;

class OriginalRigBaker {
 public:
  OriginalRigBaker(const OriginalFace& face, const UnriggedHead& model)
      : face_(face), model_(model), own_(face.wireframe) {
    // Units belong to the standard wireframe and are scaled with the face, so that its lids meet:
    // in x with the distance of the eyes, in y with the height from eyes to mouth. Offsets of
    // mouths are not scaled, as in the original: small faces move theirs relatively more.
    const OriginalSpace standard(face.standard);
    const auto height = [](const OriginalSpace& space, const PntFile& file) {
      return space.EyeOpening(file, Side::kRight).y - space.PositionMm(file, kLipMiddle).y;
    };
    const float tall = height(own_, face.wireframe) / height(standard, face.standard);
    unit_scale_ = standard.mm() * glm::vec3(1, std::clamp(tall, 0.5f, 2.0f), 1);
  }

  RigData Bake(const VisemeMouths& mouths, const MouthUnitSizes& unit_sizes) {
    rig_ = MakeStillSkin();
    rig_.steps = {RigStep::kChannels, RigStep::kLips, RigStep::kJawByChin};
    rig_.lips = LipsOf(model_, face_.wireframe.positions.size());
    rig_.jaw.chin = static_cast<std::uint32_t>(face_.wireframe.index.at(kChin));
    AddUnits();
    for (std::size_t k = 0; k < face_.expression_residuals.size(); ++k) {
      Add(Moves(face_.expression_residuals[k], unit_scale_),
          {{{.kind = Drive::Kind::kResidual, .number = static_cast<std::uint16_t>(k)}}});
    }
    AddVisemes(mouths);
    for (std::size_t k = 0; k < face_.mouth_units.size(); ++k) {
      if (unit_sizes[k] == 0) continue;
      Channel& channel =
          Add(Moves(face_.mouth_units[k], glm::vec3(own_.mm())),
              {{{.kind = Drive::Kind::kHandMouth, .number = static_cast<std::uint16_t>(k)},
                1 / unit_sizes[k]}});
      channel.min = 0;
      channel.max = 2;
    }
    return std::move(rig_);
  }

 private:
  static Drive Asked(std::size_t unit, Side side) {
    return {.kind = Drive::Kind::kCommandedUnit,
            .number = static_cast<std::uint16_t>(unit),
            .side = Drive::OnlyOf(side)};
  }

  static std::vector<Displacement> Moves(const std::vector<glm::vec3>& offsets,
                                         const glm::vec3& scale) {
    constexpr float kMin = 0.02f;  // millimetres
    std::vector<Displacement> moves;
    for (std::uint32_t i = 0; i < offsets.size(); ++i) {
      const glm::vec3 by = offsets[i] * scale;
      if (glm::length(by) > kMin) moves.push_back({i, by});
    }
    return moves;
  }

  Channel& Add(std::vector<Displacement> moves, std::vector<Channel::Driver> drivers) {
    Channel& channel = rig_.channels.emplace_back();
    channel.drivers = std::move(drivers);
    channel.moves = std::move(moves);
    return channel;
  }

  /// Adds the channels of units. They follow the commanded strengths, because the original's units
  /// add up, while ours damp and oppose each other.
  void AddUnits() {
    const float middle = 0.5f * (own_.PositionMm(face_.wireframe, kLipCorners.right).x +
                                 own_.PositionMm(face_.wireframe, kLipCorners.left).x);
    for (std::size_t k = 0; k < face_.units.size(); ++k) {
      const std::vector<Displacement> both = Moves(face_.units[k], unit_scale_);
      for (const Side side : kSides) {
        std::vector<Displacement> moves = both;
        for (Displacement& d : moves) {
          const float share = LeftShareAt(model_.mesh.position[d.vertex].x - middle);
          d.offset *= side == Side::kLeft ? share : 1 - share;
        }
        const auto number = static_cast<std::size_t>(kUnitNumbers[k]);
        Channel& channel = Add(std::move(moves), {{Asked(number, side)}});
        if (number != kEyesClosed) continue;
        channel.drivers.push_back({{.kind = Drive::Kind::kBlink, .side = Drive::OnlyOf(side)}});
      }
    }
  }

  void AddVisemes(const VisemeMouths& mouths) {
    constexpr float kMaxOfViseme = 1.5f;
    const std::size_t count = std::min(face_.visemes.size(), mouths.size());
    MouthFit mouth(count);
    std::vector<NnlsSolver::Row> keys;
    for (std::size_t k = 0; k < count; ++k) {
      MouthFit::Weights weights(count, 0.0f);
      weights[k] = kVisemeShare;
      mouth.AddViseme(mouths[k], std::move(weights));
      for (float& value : keys.emplace_back(mouths[k].begin(), mouths[k].end())) {
        value /= kVisemeShare;
      }
    }
    const NnlsSolver mix(std::move(keys));
    mouth.AddParameters([&mix](const FaceState& state) { return mix.Solve(state.mouth).weights; });
    for (std::size_t i = count; i < mouths.size(); ++i) {
      mouth.AddViseme(mouths[i], mix.Solve(mouths[i]).weights);
    }
    DriveFit fit(count);
    mouth.AddTo(fit, Drive::Kind::kSpokenMouth);
    const auto drivers = fit.ReleaseDrivers();
    for (std::size_t k = 0; k < count; ++k) {
      Channel& channel = Add(Moves(face_.visemes[k], glm::vec3(own_.mm())), drivers[k]);
      channel.min = 0;
      channel.max = kMaxOfViseme;
    }
  }

  const OriginalFace& face_;
  const UnriggedHead& model_;
  OriginalSpace own_;
  glm::vec3 unit_scale_{1};
  RigData rig_;
};

}  // namespace

RigData RigOfOriginal(const OriginalFace& face, const UnriggedHead& model,
                      const VisemeMouths& mouths, const MouthUnitSizes& unit_sizes) {
  return OriginalRigBaker(face, model).Bake(mouths, unit_sizes);
}

}  // namespace fsm
