#include "fsm/mesh/rigging/blendshape_rig.h"

#include <algorithm>
#include <utility>

#include "fsm/mesh/rig_unrigged_head.h"
#include "fsm/mesh/rigging/shape_solver.h"
#include "fsm/mesh/transfer/drive_fit.h"

namespace fsm {
namespace {

/// Detaches teeth and tongue from the jaw if shapes move them.
void DetachFromBones(const ImportedHead& file, const KnownShapes& known, UnriggedHead& model) {
  std::vector<bool> moves(model.mesh.position.size(), false);
  for (const KnownShapes::Moves& shape : known.moves) {
    for (const Displacement& d : shape) moves[d.vertex] = true;
  }
  for (const auto& part : file.parts) {
    if (std::ranges::none_of(part.indices, [&](std::uint32_t v) { return moves[v]; })) continue;
    for (const std::uint32_t v : part.indices) {
      if (!SideOfEye(model.mesh.bone[v])) model.mesh.bone[v] = Bone::kSkin;
    }
  }
}

/// Finds the drivers of every shape from states in which a single number is not 0, and from
/// visemes.
std::vector<std::vector<Channel::Driver>> FitDrivers(ShapeSolver& solver, const UnitTable& units,
                                                     std::span<const FaceState> visemes) {
  // Shapes that reproduce less of a unit than this merely move the same vertices by chance.
  constexpr float kMinShown = 0.2f;
  const auto solve = [&solver](const FaceState& state) { return solver.Solve(state); };
  DriveFit fit(solver.count());
  for (const int unit : units.Numbers()) {
    const auto number = static_cast<std::uint16_t>(unit);
    const auto state_of = [number](const Sided<bool>& raised) {
      FaceState state;
      for (const Side side : kSides) state.au[side][number] = raised[side] ? 1 : 0;
      return state;
    };
    // The jaw's sway to both sides cancels out, so each side is also fitted alone.
    const float shown = std::max({solver.ShareShown(state_of({true, true})),
                                  solver.ShareShown(state_of({.right = true})),
                                  solver.ShareShown(state_of({.left = true}))});
    if (shown < kMinShown) continue;
    fit.AddSided({.kind = Drive::Kind::kUnit, .number = number}, 1,
                 [&](const Sided<bool>& raised) { return solve(state_of(raised)); });
  }
  fit.AddSided({.kind = Drive::Kind::kBlink}, 1, [&](const Sided<bool>& raised) {
    FaceState state;
    for (const Side side : kSides) state.blink[side] = raised[side] ? 1 : 0;
    return solve(state);
  });
  constexpr float kGaze = 25;  // degrees
  for (const Drive::Kind kind : {Drive::Kind::kGazeUp, Drive::Kind::kGazeRight}) {
    for (const Drive::Half half : {Drive::Half::kPositive, Drive::Half::kNegative}) {
      const float angle = half == Drive::Half::kPositive ? kGaze : -kGaze;
      fit.AddSided({.kind = kind, .half = half}, kGaze, [&](const Sided<bool>& raised) {
        FaceState state;
        const EyeAngles gaze =
            kind == Drive::Kind::kGazeUp ? EyeAngles{-angle, 0} : EyeAngles{0, angle};
        for (const Side side : kSides) {
          if (raised[side]) state.gaze[side] = gaze;
        }
        return solve(state);
      });
    }
  }
  MouthFit mouth(solver.count());
  mouth.AddParameters(solve);
  for (FaceState state : visemes) {
    state.seal = 0;  // the channels' factors seal the lips
    mouth.AddViseme(state.mouth, solve(state));
  }
  mouth.AddTo(fit, Drive::Kind::kMouth);
  return fit.ReleaseDrivers();
}

/// Adds drivers of shapes that move the eyes: one shape moves both eyes, so each eye's gaze drives
/// it by half. The agent's left is the viewer's right.
void AddGazeShapes(const KnownShapes& known, const GazeRanges& ranges,
                   std::vector<Channel>& channels) {
  using enum Drive::Kind;
  using enum Drive::Half;
  struct GazeShape {
    const char* name;
    Drive::Kind kind;
    Drive::Half half;
    GazeRange range;
  };
  for (const GazeShape& shape : {GazeShape{kGazeShapes[0], kGazeRight, kPositive, ranges.outer},
                                 GazeShape{kGazeShapes[1], kGazeRight, kNegative, ranges.outer},
                                 GazeShape{kGazeShapes[2], kGazeUp, kPositive, ranges.up},
                                 GazeShape{kGazeShapes[3], kGazeUp, kNegative, ranges.down}}) {
    const auto found = known.gazes.find(shape.name);
    if (found == known.gazes.end()) continue;
    Channel& channel = channels.emplace_back();
    for (const Side side : kSides) {
      channel.drivers.push_back(
          {{.kind = shape.kind, .side = Drive::OnlyOf(side), .half = shape.half},
           0.5f / std::max(shape.range.gaze_deg, 1e-3f)});
    }
    channel.min = 0;
    channel.max = 1;
    channel.moves = found->second;
    for (Displacement& d : channel.moves) d.offset *= std::min(shape.range.output, 1.0f);
  }
}

/// Adds a channel for every shape with drivers.
void AddShapes(const KnownShapes& known, const ShapeSolver& solver,
               std::vector<std::vector<Channel::Driver>> drivers, std::vector<Channel>& channels) {
  constexpr float kMaxWeight = 1.5f;
  const auto add = [&](std::size_t driven_as, std::size_t shape) -> Channel& {
    Channel& channel = channels.emplace_back();
    channel.drivers = drivers[driven_as];
    channel.min = 0;
    channel.max = kMaxWeight;
    channel.moves = known.moves[shape];
    return channel;
  };
  // ARKit's mouthClose closes the lips that jawOpen opens and has no meaning without it. If the
  // file has it, it seals the lips; else sealing reduces their opening.
  const std::size_t close = known.IndexOf("mouthclose"), jaw = known.IndexOf("jawopen");
  const bool closes = std::max(close, jaw) < known.names.size();
  if (closes) add(jaw, close).open_factor = 0;
  for (std::size_t k = 0; k < known.moves.size(); ++k) {
    const bool kept = closes && k == jaw;
    Channel& channel = add(k, k);
    if (solver.Opens(k) && !kept) channel.sealed_factor = 0;
  }
  std::erase_if(channels, [](const Channel& channel) { return channel.drivers.empty(); });
}

}  // namespace

BlendshapeRig MakeBlendshapeRig(const ImportedHead& file, const Similarity& to_ours,
                                UnriggedHead& model, const ShapeMeanings& meanings,
                                const Head& driven, std::span<const FaceState> visemes) {
  constexpr std::size_t kFewest = 4;
  KnownShapes known = RecogniseShapes(file, to_ours, model, meanings.shapes);
  if (known.names.size() < kFewest) return {std::nullopt, std::move(known.unused)};
  DetachFromBones(file, known, model);
  ShapeSolver solver(meanings.source, driven);
  for (const FaceState& meaning : known.meanings) solver.Add(meaning);
  RigData rig = MakeStillSkin();
  rig.steps = {RigStep::kChannels};
  rig.units = driven.rig().data().units;
  rig.asymmetry_seed = driven.rig().data().asymmetry_seed;
  AddShapes(known, solver, FitDrivers(solver, rig.units, visemes), rig.channels);
  AddGazeShapes(known, file.eye_rig.gaze_ranges.value_or(GazeRanges{}), rig.channels);
  return {std::move(rig), std::move(known.unused)};
}

}  // namespace fsm
