#include "fsm/mesh/transfer/blendshape_rig.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <set>

#include "fsm/mesh/mesh_head.h"
#include "fsm/mesh/transfer/drive_fit.h"
#include "fsm/mesh/transfer/nnls_solver.h"
#include "fsm/mesh/transfer/transferred_rig.h"

namespace fsm {
namespace {

using Moves = std::vector<Displacement>;

constexpr float kMostOfShape = 1.5f;

/// Returns the rig of a head with only the steps that move the face's skin.
Rig FaceOnly(const Head& head) {
  using enum RigStep;
  RigData rig = head.rig().data();
  std::erase_if(rig.steps, [](RigStep step) {
    return step == kTongue || step == kBones || step == kNeck || step == kNormals;
  });
  return Rig(std::move(rig));
}

/// Finds the weights of shapes that reproduce a head in a state. Slow; for baking.
class ShapeSolver {
 public:
  /// `source` defines the displacements of the shapes, `moved`, which has the same form, those of
  /// the states.
  ShapeSolver(const Head& source, const Head& moved)
      : source_(FaceOnly(source)), moved_(FaceOnly(moved)) {
    HeadVertices vertices;
    source_.Evaluate({}, vertices);
    rest_ = std::move(vertices.position);
    ChooseProbes(SkinTriangles(source.topology()));
  }

  /// Adds a shape, which looks as `source` does in this state.
  void Add(const FaceState& meaning) {
    ProbeMotion motion = MotionOf(source_, meaning);
    opens_mm_.push_back(OpensOnlyMouth(motion.moves) ? motion.gap_mm : 0.0f);
    keys_.push_back(std::move(motion.moves));
    mix_.reset();
  }
  std::size_t count() const { return keys_.size(); }
  /// Tells whether a shape only opens the mouth.
  bool Opens(std::size_t shape) const { return opens_mm_[shape] > 0; }

  std::vector<float> Solve(const FaceState& state) {
    if (!mix_) mix_.emplace(keys_);
    const ProbeMotion motion = MotionOf(moved_, state);
    std::vector<float> weights = mix_->Solve(motion.moves).weights;
    HoldShut(motion.gap_mm, weights);
    return weights;
  }
  /// Returns the part of a state's movement that the shapes can reproduce, 0..1 of its sum of
  /// squares.
  float PartShown(const FaceState& state) {
    if (!mix_) mix_.emplace(keys_);
    const NnlsSolver::Row moves = MotionOf(moved_, state).moves;
    const NnlsSolver::Row residual = mix_->Solve(moves).residual;
    const float all = std::inner_product(moves.begin(), moves.end(), moves.begin(), 0.0f);
    const float left = std::inner_product(residual.begin(), residual.end(), residual.begin(), 0.0f);
    return all > 0 ? 1 - left / all : 0;
  }

 private:
  struct ProbeMotion {
    NnlsSolver::Row moves;  ///< displacements of the probes
    float gap_mm;           ///< gap between the lips
  };

  /// Selects vertices of the face that are a few millimetres apart.
  void ChooseProbes(std::span<const std::uint32_t> skin) {
    constexpr float kApart = 5;
    for (const std::uint32_t v : skin) {
      const glm::vec3 p = rest_[v];
      if (p.z < 30 || p.y < -105 || p.y > 75) continue;
      if (std::ranges::none_of(
              probes_, [&](std::uint32_t w) { return glm::distance(rest_[w], p) < kApart; })) {
        probes_.push_back(v);
      }
    }
  }

  ProbeMotion MotionOf(const Rig& face, const FaceState& state) {
    face.Evaluate(state, vertices_);
    ProbeMotion motion{.moves = {}, .gap_mm = 0};
    motion.moves.reserve(3 * probes_.size());
    for (const std::uint32_t v : probes_) {
      for (int c = 0; c < 3; ++c) motion.moves.push_back(vertices_.position[v][c] - rest_[v][c]);
    }
    if (const auto& lips = face.data().lips.measured) {
      motion.gap_mm = std::max(vertices_.position[(*lips)[LipRig::kUpperLip]].y -
                                   vertices_.position[(*lips)[LipRig::kLowerLip]].y,
                               0.0f);
    }
    return motion;
  }

  /// Tells whether a state moves only vertices below the nose.
  bool OpensOnlyMouth(const NnlsSolver::Row& look) const {
    constexpr float kBelow = -10, kRest = 0.1f;
    float above = 0, all = 0;
    for (std::size_t i = 0; i < look.size(); ++i) {
      all += look[i] * look[i];
      if (rest_[probes_[i / 3]].y > kBelow) above += look[i] * look[i];
    }
    return above < kRest * all;
  }

  /// For a closed mouth, a combination with the lips slightly open may fit as well, but p, b and m
  /// must close. Shapes that only open the mouth are therefore limited so that it opens no wider
  /// than in `moved`.
  void HoldShut(float wanted_mm, std::vector<float>& weights) const {
    float open = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) open += weights[k] * opens_mm_[k];
    if (open <= std::max(wanted_mm, 1e-3f)) return;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      if (opens_mm_[k] > 0) weights[k] *= wanted_mm / open;
    }
  }

  Rig source_, moved_;
  HeadVertices vertices_;  // of the state evaluated last
  std::vector<glm::vec3> rest_;
  std::vector<std::uint32_t> probes_;
  std::vector<NnlsSolver::Row> keys_;
  std::vector<float> opens_mm_;  // by shape; 0 unless it only opens the mouth
  std::optional<NnlsSolver> mix_;
};

/// The shapes of a file whose names have a meaning.
struct KnownShapes {
  std::vector<std::string> names;
  std::vector<Moves> moves;
  std::map<std::string, Moves, std::less<>> gazes;  ///< shapes that move the eyes
  std::vector<std::string> unused;                  ///< names, as in the file, of all others
};

constexpr const char* kGazeShapes[] = {"vrmlookleft", "vrmlookright", "vrmlookup", "vrmlookdown"};

/// Returns the state with only one side of the face active.
FaceState OnlyOn(Side side, FaceState state) {
  const Side other = side == Side::kLeft ? Side::kRight : Side::kLeft;
  state.au[other] = {};
  state.gaze[other] = {};
  state.blink[other] = 0;
  return state;
}

/// Finds the meanings of a file's shapes by their normalised names.
class MeaningFinder {
 public:
  MeaningFinder(const ImportedHead& file, std::span<const ShapeMeaning> meanings) {
    for (const ShapeMeaning& meaning : meanings) states_.emplace(meaning.name, &meaning.state);
    for (const auto& shape : file.shapes) given_.insert(PlainShapeName(shape.name));
  }
  bool Given(const std::string& name) const { return given_.contains(name); }

  std::optional<FaceState> Of(const std::string& name) const {
    if (const auto found = states_.find(name); found != states_.end()) return *found->second;
    // Avatars made for face tracking have expressions with the names of ARKit's shapes.
    if (name.starts_with("vrm")) {
      const std::string own = name.substr(3);
      return Given(own) ? std::nullopt : Of(own);
    }
    // The left or right half of a shape that ARKit does not split, unless the file has the whole
    // too.
    for (const auto& [end, side] : {std::pair("left", Side::kLeft), {"right", Side::kRight}}) {
      if (!name.ends_with(end)) continue;
      const std::string whole = name.substr(0, name.size() - std::string_view(end).size());
      const auto found = states_.find(whole);
      if (found != states_.end() && !Given(whole)) return OnlyOn(side, *found->second);
    }
    return std::nullopt;
  }

 private:
  std::map<std::string, const FaceState*> states_;
  std::set<std::string> given_;
};

KnownShapes Recognise(const ImportedHead& file, const Similarity& to_ours, const MeshModel& model,
                      std::span<const ShapeMeaning> meanings, ShapeSolver& solver) {
  const MeaningFinder finder(file, meanings);
  KnownShapes known;
  for (const auto& shape : file.shapes) {
    std::string name = PlainShapeName(shape.name);
    // The eyes rotate without shapes.
    const bool but_eyes = name.find("eyelook") != std::string::npos && model.has_eyes;
    Moves moves;
    for (const auto& [vertex, by] : shape.deltas) {
      if (but_eyes && EyeOf(model.bone[vertex])) continue;
      moves.push_back({vertex, to_ours.scale * (to_ours.turn * by)});
    }
    if (file.gaze_by_shape && std::ranges::find(kGazeShapes, name) != std::end(kGazeShapes)) {
      known.gazes[name] = std::move(moves);
      continue;
    }
    const auto meaning = finder.Of(name);
    if (!meaning) {
      // A VRM expression that only repeats a shape, or moves nothing, is not reported as unused.
      const bool repeats = name.starts_with("vrm") && finder.Given(name.substr(3));
      const bool gazes = std::ranges::find(kGazeShapes, name) != std::end(kGazeShapes);
      if (!repeats && !gazes && !moves.empty()) {
        known.unused.push_back(shape.name.starts_with("vrm") ? shape.name.substr(3) : shape.name);
      }
      continue;
    }
    solver.Add(*meaning);
    known.names.push_back(std::move(name));
    known.moves.push_back(std::move(moves));
  }
  return known;
}

/// Detaches teeth and tongue from the jaw if shapes move them.
void FreeWhatMoves(const ImportedHead& file, const KnownShapes& known, MeshModel& model) {
  std::vector<bool> moves(model.position.size(), false);
  for (const Moves& shape : known.moves) {
    for (const Displacement& d : shape) moves[d.vertex] = true;
  }
  for (const auto& part : file.parts) {
    if (std::ranges::none_of(part.indices, [&](std::uint32_t v) { return moves[v]; })) continue;
    for (const std::uint32_t v : part.indices) {
      if (!EyeOf(model.bone[v])) model.bone[v] = Bone::kSkin;
    }
  }
}

/// Finds the drivers of every shape from states in which a single number is not 0, and from
/// visemes.
std::vector<std::vector<Channel::Driver>> FitDrivers(ShapeSolver& solver, const UnitTable& units,
                                                     std::span<const FaceState> visemes) {
  // Shapes that reproduce less of a unit than this merely move the same vertices by chance.
  constexpr float kLeastShown = 0.2f;
  const auto solve = [&solver](const FaceState& state) { return solver.Solve(state); };
  DriveFit fit(solver.count());
  for (const int unit : units.Numbers()) {
    const auto number = static_cast<std::uint16_t>(unit);
    const auto state_of = [number](bool right, bool left) {
      FaceState state;
      state.au.right[number] = right ? 1 : 0;
      state.au.left[number] = left ? 1 : 0;
      return state;
    };
    // The jaw's sway to both sides cancels out, so each side is also fitted alone.
    const float shown =
        std::max({solver.PartShown(state_of(true, true)), solver.PartShown(state_of(true, false)),
                  solver.PartShown(state_of(false, true))});
    if (shown < kLeastShown) continue;
    fit.AddSided({.kind = Drive::Kind::kUnit, .number = number}, 1,
                 [&](bool right, bool left) { return solve(state_of(right, left)); });
  }
  fit.AddSided({.kind = Drive::Kind::kBlink}, 1, [&](bool right, bool left) {
    FaceState state;
    state.blink.right = right ? 1 : 0;
    state.blink.left = left ? 1 : 0;
    return solve(state);
  });
  constexpr float kGaze = 25;  // degrees
  for (const Drive::Kind kind : {Drive::Kind::kGazeUp, Drive::Kind::kGazeRight}) {
    for (const Drive::Half half : {Drive::Half::kPositive, Drive::Half::kNegative}) {
      const float angle = half == Drive::Half::kPositive ? kGaze : -kGaze;
      fit.AddSided({.kind = kind, .half = half}, kGaze, [&](bool right, bool left) {
        FaceState state;
        const EyeAngles gaze =
            kind == Drive::Kind::kGazeUp ? EyeAngles{-angle, 0} : EyeAngles{0, angle};
        if (right) state.gaze.right = gaze;
        if (left) state.gaze.left = gaze;
        return solve(state);
      });
    }
  }
  MouthFit mouth(solver.count());
  mouth.AddParameters(solve);
  for (FaceState state : visemes) {
    state.lip_seal = 0;  // the channels' factors seal the lips
    mouth.AddViseme(state.mouth, solve(state));
  }
  mouth.AddTo(fit, Drive::Kind::kMouth);
  return fit.TakeDrivers();
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
    channel.least = 0;
    channel.most = 1;
    channel.moves = found->second;
    for (Displacement& d : channel.moves) d.by *= std::min(shape.range.turn, 1.0f);
  }
}

}  // namespace

std::optional<RigData> MakeBlendshapeRig(const ImportedHead& file, const Similarity& to_ours,
                                         MeshModel& model, const ShapeMeanings& meanings,
                                         const Head& moved, std::span<const FaceState> visemes,
                                         std::vector<std::string>* unused) {
  constexpr std::size_t kFewest = 4;
  ShapeSolver solver(meanings.source, moved);
  KnownShapes known = Recognise(file, to_ours, model, meanings.shapes, solver);
  if (unused) *unused = known.unused;
  if (known.names.size() < kFewest) return std::nullopt;
  FreeWhatMoves(file, known, model);
  RigData rig = MakeStillSkin();
  rig.steps = {RigStep::kChannels};
  rig.units = moved.rig().data().units;
  auto drivers = FitDrivers(solver, rig.units, visemes);
  // ARKit's mouthClose closes the lips that jawOpen opens and has no meaning without it. If the
  // file has it, it seals the lips; else sealing reduces their opening.
  const auto shape_of = [&known](const char* name) {
    return static_cast<std::size_t>(std::ranges::find(known.names, name) - known.names.begin());
  };
  const std::size_t close = shape_of("mouthclose"), jaw = shape_of("jawopen");
  const bool closes = std::max(close, jaw) < known.names.size();
  const auto add = [&rig](std::vector<Channel::Driver> by, Moves moves) -> Channel& {
    Channel& channel = rig.channels.emplace_back();
    channel.drivers = std::move(by);
    channel.least = 0;
    channel.most = kMostOfShape;
    channel.moves = std::move(moves);
    return channel;
  };
  if (closes) add(drivers[jaw], known.moves[close]).open_factor = 0;
  for (std::size_t k = 0; k < known.moves.size(); ++k) {
    const bool kept = closes && k == jaw;
    Channel& channel = add(std::move(drivers[k]), std::move(known.moves[k]));
    if (solver.Opens(k) && !kept) channel.sealed_factor = 0;
  }
  std::erase_if(rig.channels, [](const Channel& channel) { return channel.drivers.empty(); });
  AddGazeShapes(known, file.gaze_ranges.value_or(GazeRanges{}), rig.channels);
  return rig;
}

}  // namespace fsm
