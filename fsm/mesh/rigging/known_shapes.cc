#include "fsm/mesh/rigging/known_shapes.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <set>

namespace fsm {
namespace {

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

}  // namespace

std::size_t KnownShapes::IndexOf(std::string_view name) const {
  return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}

KnownShapes RecogniseShapes(const ImportedHead& file, const Similarity& to_ours,
                            const UnriggedHead& model, std::span<const ShapeMeaning> meanings) {
  const MeaningFinder finder(file, meanings);
  KnownShapes known;
  for (const auto& shape : file.shapes) {
    std::string name = PlainShapeName(shape.name);
    // The eyes rotate without shapes.
    const bool eyes_excepted = name.find("eyelook") != std::string::npos && model.has_eyes;
    KnownShapes::Moves moves;
    for (const auto& [vertex, by] : shape.moves) {
      if (eyes_excepted && SideOfEye(model.mesh.bone[vertex])) continue;
      moves.push_back({vertex, to_ours.scale * (to_ours.rotation * by)});
    }
    const bool gazes = std::ranges::find(kGazeShapes, name) != std::end(kGazeShapes);
    if (gazes && file.gaze_by_shape) {
      known.gazes[name] = std::move(moves);
      continue;
    }
    const auto meaning = finder.Of(name);
    if (!meaning) {
      // A VRM expression that only repeats a shape, or moves nothing, is not reported as unused.
      const bool names_given_shape = name.starts_with("vrm") && finder.Given(name.substr(3));
      if (!names_given_shape && !gazes && !moves.empty()) {
        known.unused.push_back(shape.name.starts_with("vrm") ? shape.name.substr(3) : shape.name);
      }
      continue;
    }
    known.meanings.push_back(*meaning);
    known.names.push_back(std::move(name));
    known.moves.push_back(std::move(moves));
  }
  return known;
}

}  // namespace fsm
