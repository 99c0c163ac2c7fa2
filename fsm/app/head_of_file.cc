#include "fsm/app/head_of_file.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <iostream>
#include <stdexcept>

#include "fsm/app/face_of_name.h"
#include "fsm/head/make_head.h"
#include "fsm/mesh/head_file.h"
#include "fsm/mesh/obj_file.h"
#include "fsm/mesh/pnt_file.h"
#include "fsm/motion/face_motion.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

template <typename T>
T OrThrow(vm::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text);
  return std::move(*result);
}

/// VRM's expressions, as mouth shapes of the set of 14 and emotions.
constexpr std::pair<const char*, const char*> kVrmMouths[] = {
    {"vrma", "a"},  {"vrmi", "i"},  {"vrmu", "u"},  {"vrme", "e"},  {"vrmo", "o"},
    {"vrmaa", "a"}, {"vrmih", "i"}, {"vrmou", "u"}, {"vrmee", "e"}, {"vrmoh", "o"}};
constexpr std::pair<const char*, const char*> kVrmEmotions[] = {
    {"vrmjoy", "HAPPY"},  {"vrmhappy", "HAPPY"}, {"vrmangry", "ANGRY"},
    {"vrmsorrow", "SAD"}, {"vrmsad", "SAD"},     {"vrmsurprised", "SURPRISED"}};
constexpr std::tuple<const char*, bool, bool> kVrmBlinks[] = {{"vrmblink", true, true},
                                                              {"vrmblinkr", true, false},
                                                              {"vrmblinkl", false, true},
                                                              {"vrmblinkright", true, false},
                                                              {"vrmblinkleft", false, true}};

std::vector<ShapeMeaning> Meanings(const MotionTables& tables) {
  std::vector<ShapeMeaning> meanings;
  for (ExportedShape& shape : ArkitShapes(tables)) {
    meanings.push_back({PlainShapeName(shape.name), shape.state});
  }
  for (const auto& [name, mouth] : kVrmMouths) {
    const Viseme* shape = FindShape(tables.set14.shapes, mouth);
    if (!shape) continue;
    FaceState state;
    state.mouth = shape->pose.mouth;
    meanings.push_back({name, state});
  }
  for (const auto& [name, emotion] : kVrmEmotions) {
    FaceMotion motion(tables, 1);
    if (!motion.Express(0ms, emotion, 1, 1, 0ms)) continue;
    meanings.push_back({name, motion.StateAt(5s)});
  }
  for (const auto& [name, right, left] : kVrmBlinks) {
    FaceState state;
    state.blink_right = right ? 1 : 0;
    state.blink_left = left ? 1 : 0;
    meanings.push_back({name, state});
  }
  return meanings;
}

/// The head of a file that ExportHead has written; null if it is of another kind.
std::unique_ptr<Head> AssetOfFile(const std::string& path) {
  if (!path.ends_with(".glb")) return nullptr;
  const auto bytes = ReadWhole(path, kMaxMeshBytes);
  if (!bytes || !IsAsset(*bytes)) return nullptr;
  return std::make_unique<Head>(OrThrow(ParseAsset(path, *bytes)));
}

/// The mouths of both sets at full articulation.
std::vector<FaceState> VisemeStates(const MotionTables& tables) {
  std::vector<FaceState> states;
  for (const Visemes* shapes : {&tables.set14.shapes, &tables.set28.shapes}) {
    for (const Viseme& viseme : *shapes) {
      FaceState& state = states.emplace_back();
      state.mouth = viseme.pose.mouth;
      state.lip_seal = viseme.pose.seal;
    }
  }
  return states;
}

struct Placed {
  Similarity place;
  float mouth_y = -43;
  std::vector<PlacePair> pairs;  // in our frame
  std::string face = "galatea";
};

Placed PlaceByPoints(const HeadPoints& points) {
  Placed placed;
  placed.face = points.face;
  placed.place = FitSimilarity(points.pairs);
  float sum = 0, count = 0;
  for (PlacePair pair : points.pairs) {
    pair.to = placed.place(pair.to);
    if (pair.part == FacePart::kUpperLip || pair.part == FacePart::kLowerLip) {
      sum += pair.to.y;
      count += 1;
    }
    placed.pairs.push_back(pair);
  }
  if (count > 0) placed.mouth_y = sum / count;
  return placed;
}

/// By its eyes, else by its outline: the upper part of what stands much higher than wide.
Placed PlaceByLook(const HeadFile& file) {
  Placed placed;
  const MeshModel raw = ModelOf(file, {}, 0);
  if (raw.has_eyes) {
    const glm::vec3 apart = raw.eyes[1].centre - raw.eyes[0].centre;
    const glm::vec3 middle = 0.5f * (raw.eyes[0].centre + raw.eyes[1].centre);
    placed.place.scale = 2 * kEyePlace.x / std::max(glm::length(apart), 1e-6f);
    placed.place.move = kEyePlace * glm::vec3(0, 1, 1) - placed.place.scale * middle;
    return placed;
  }
  glm::vec3 low(1e9f), high(-1e9f);
  for (const glm::vec3& p : file.position) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const glm::vec3 size = high - low;
  const float head = size.y > 2.2f * size.x ? size.y / 7.5f : size.y;
  constexpr float kHeadMm = 250, kTopMm = 130;
  placed.place.scale = kHeadMm / std::max(head, 1e-6f);
  placed.place.move =
      glm::vec3(-placed.place.scale * 0.5f * (low.x + high.x), kTopMm - placed.place.scale * high.y,
                -placed.place.scale * 0.5f * (low.z + high.z));
  return placed;
}

}  // namespace

std::vector<ExportedShape> ArkitShapes(const MotionTables& tables) {
  std::vector<ExportedShape> shapes;
  for (const auto& [name, units] : tables.blend_shapes) {
    FaceMotion motion(tables, 1);
    MotionSettings settings;
    settings.gaze_distance_mm = 0;
    motion.Apply(0ms, settings);
    if (!motion.SetBlendShape(0ms, name, 1, 0ms)) continue;
    shapes.push_back({name, motion.StateAt(5s)});
    shapes.back().state.asymmetry = 0;  // left and right shapes are each other's image
  }
  return shapes;
}

std::unique_ptr<Head> MakeHeadOfFile(const std::string& path, const std::string& tables_folder,
                                     HeadTelling* telling) {
  if (auto own = AssetOfFile(path)) return MovedAsIn(tables_folder, std::move(own));
  const HeadFile file = OrThrow(ReadHeadFile(path));
  const auto tell = [&](const std::string& what) {
    const std::string told = "'" + path + "': " + what;
    if (telling) {
      telling->notice += (telling->notice.empty() ? "" : "; ") + told;
    } else {
      std::cerr << "fsm: notice: " << told << "\n";
    }
  };
  for (const std::string& what : file.notices) tell(what);
  if (telling) telling->beside = file.beside;
  const MotionTables tables = OrThrow(MotionTables::Load(tables_folder));
  const std::string beside = path + ".points";
  std::error_code code;
  const bool has_points = std::filesystem::exists(beside, code);
  Placed placed;
  if (has_points) {
    const std::string text = OrThrow(ReadWhole(beside, 1U << 20));
    placed = PlaceByPoints(OrThrow(ParseHeadPoints(beside, text)));
  } else {
    placed = PlaceByLook(file);
  }
  MeshModel model = ModelOf(file, placed.place, placed.mouth_y);
  if (!file.shapes.empty()) {
    const auto source = MakeHead(placed.face, false);
    const auto units = UnitsIn(tables_folder);
    const auto moved = units ? source->WithUnits(*units) : nullptr;
    const std::vector<ShapeMeaning> shapes = Meanings(tables);
    if (auto skin = BlendshapeRig(file, placed.place, model, {*source, shapes},
                                  moved ? *moved : *source, VisemeStates(tables))) {
      return MakeMeshHead(std::move(model), std::move(*skin));
    }
  }
  if (has_points) {
    RigData skin =
        TransferredRig(model, *MovedAsIn(tables_folder, MakeHead(placed.face)), placed.pairs);
    return MakeMeshHead(std::move(model), std::move(skin));
  }
  tell("has no shapes with names of ARKit or VRM, and no '" + beside +
       "' says where its eyes and mouth are (face_fit --head finds out): only head, eyes and jaw "
       "move");
  return MovedAsIn(tables_folder, MakeMeshHead(std::move(model)));
}

vm::Result<void> ExportHead(const Head& head, const MotionTables& tables, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  const auto shapes = ArkitShapes(tables);
  if (!(file << WriteAsset(head, shapes)).flush()) {
    return vm::Fail(vm::Errc::kUnavailable, "cannot write '" + path + "'");
  }
  return {};
}

}  // namespace fsm
