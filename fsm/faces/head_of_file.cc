#include "fsm/faces/head_of_file.h"

#include <chrono>
#include <filesystem>
#include <glm/geometric.hpp>

#include "embedded/vrm.h"
#include "fsm/asset/asset_reader.h"
#include "fsm/base/box.h"
#include "fsm/base/table_reader.h"
#include "fsm/faces/face_of_name.h"
#include "fsm/faces/table_check.h"
#include "fsm/head/anatomy.h"
#include "fsm/head/make_head.h"
#include "fsm/mesh/align_imported_head.h"
#include "fsm/mesh/imported_head.h"
#include "fsm/mesh/mesh_limits.h"
#include "fsm/mesh/rig_unrigged_head.h"
#include "fsm/mesh/rigging/blendshape_rig.h"
#include "fsm/mesh/rigging/transferred_rig.h"
#include "fsm/motion/face_motion.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

/// Returns the state of a row of tables/vrm.txt; nothing if the tables of motion have no such shape
/// or expression.
std::optional<FaceState> StateOfVrmRow(const TableRow& row, const MotionTables& tables) {
  const std::string &kind = row.Word(1), &what = row.Word(2);
  FaceState state;
  if (kind == "mouth") {
    const Viseme* shape = FindViseme(tables.set(VisemeSetId::k14).visemes, what);
    if (!shape) return std::nullopt;
    state = StateOf(*shape);
  } else if (kind == "expression") {
    if (!tables.expressions.contains(what)) return std::nullopt;
    state = SettledAfter(tables, [&](FaceMotion& motion) {
      vm::OrThrow(motion.expression.Show(0ms, what, 1, 1, 0ms));
    });
  } else if (kind == "blink") {
    state.blink.left = what.contains('L') ? 1 : 0;
    state.blink.right = what.contains('R') ? 1 : 0;
  } else {
    row.Refuse("mouth, expression or blink expected");
  }
  return state;
}

std::vector<ShapeMeaning> Meanings(const MotionTables& tables) {
  std::vector<ShapeMeaning> meanings;
  for (ExportedShape& shape : ArkitShapes(tables)) {
    meanings.push_back({PlainShapeName(shape.name), shape.state});
  }
  static const Table vrm("tables/vrm.txt", embedded::vrm());
  for (const TableRow& row : vrm.rows()) {
    if (const auto state = StateOfVrmRow(row, tables)) meanings.push_back({row.key(), *state});
  }
  return meanings;
}

/// Reads the head of a file that ExportHead has written; null if it is another file.
std::unique_ptr<Head> ReadExportedHead(const std::string& path) {
  if (vm::LowerCase(std::filesystem::path(path).extension().string()) != ".glb") return nullptr;
  const auto bytes = vm::ReadTextFile(path, kMaxMeshBytes);
  if (!bytes || !IsAsset(*bytes)) return nullptr;
  return std::make_unique<Head>(vm::OrThrow(ParseAsset(path, *bytes)));
}

/// Returns the visemes of all sets at full articulation.
std::vector<FaceState> VisemeStates(const MotionTables& tables) {
  std::vector<FaceState> states;
  for (const auto& [id, set] : tables.sets) {
    std::ranges::transform(set.visemes, std::back_inserter(states), StateOf);
  }
  return states;
}

/// The transformation that aligns an imported head with the built-in ones.
struct Alignment {
  Similarity to_ours;
  float mouth_y = kUsualMouthY;
  std::vector<PointPair> pairs;  // in our frame; empty if there is no .points file
  std::string face = "galatea";
};

Alignment AlignByPoints(const HeadPoints& points) {
  Alignment alignment;
  alignment.face = points.face;
  alignment.to_ours = FitSimilarity(points.pairs);
  float sum = 0, count = 0;
  for (PointPair pair : points.pairs) {
    pair.to = alignment.to_ours(pair.to);
    if (pair.feature == FaceFeature::kUpperLip || pair.feature == FaceFeature::kLowerLip) {
      sum += pair.to.y;
      count += 1;
    }
    alignment.pairs.push_back(pair);
  }
  if (count > 0) alignment.mouth_y = sum / count;
  return alignment;
}

/// Returns the similarity that scales and moves `from` to `to`.
Similarity ScaledAbout(glm::vec3 from, float scale, glm::vec3 to) {
  return {.scale = scale, .translation = to - scale * from};
}

/// Aligns a head by its eyes, or without eyes by its bounding box; of a file much higher than wide
/// the upper part is taken as the head.
Alignment AlignByOutline(const ImportedHead& file) {
  Alignment alignment;
  const UnriggedHead raw = AlignImportedHead(file, {}, 0);
  if (raw.has_eyes) {
    const glm::vec3 apart = raw.eye_rig.centre.left - raw.eye_rig.centre.right;
    const glm::vec3 middle = 0.5f * (raw.eye_rig.centre.right + raw.eye_rig.centre.left);
    const glm::vec3 ours = EyeAnatomy::BuiltIn().centre();
    const float scale = 2 * ours.x / std::max(glm::length(apart), 1e-6f);
    alignment.to_ours = ScaledAbout(middle, scale, ours * glm::vec3(0, 1, 1));
    return alignment;
  }
  const Box box = Box::Of(file.position);
  const glm::vec3 size = box.size(), middle = box.centre();
  const float head = size.y > 2.2f * size.x ? size.y / 7.5f : size.y;
  constexpr float kHeadMm = 250, kTopMm = 130;
  alignment.to_ours = ScaledAbout({middle.x, box.high.y, middle.z}, kHeadMm / std::max(head, 1e-6f),
                                  {0, kTopMm, 0});
  return alignment;
}

/// Aligns a head by the .points file, if there is one, else by the outline.
Alignment AlignmentOf(const ImportedHead& file, const std::string& points) {
  std::error_code none;
  if (!std::filesystem::exists(points, none)) return AlignByOutline(file);
  const std::string text = vm::OrThrow(vm::ReadTextFile(points, 1U << 20));
  return AlignByPoints(vm::OrThrow(ParseHeadPoints(points, text)));
}

/// Makes the rig from the file's own shapes.
BlendshapeRig RigOfShapes(const ImportedHead& file, const Alignment& alignment,
                          const MotionTables& tables, const std::optional<UnitTable>& units,
                          UnriggedHead& model) {
  const auto source = MakeSymmetricHead(alignment.face);
  const auto other = units ? source->WithUnits(*units) : nullptr;
  const std::vector<ShapeMeaning> shapes = Meanings(tables);
  return MakeBlendshapeRig(file, alignment.to_ours, model, {*source, shapes},
                           other ? *other : *source, VisemeStates(tables));
}

}  // namespace

std::vector<ExportedShape> ArkitShapes(const MotionTables& tables) {
  std::vector<ExportedShape> shapes;
  MotionSettings settings;
  settings.gaze_distance_mm = 0;
  for (const auto& [name, units] : tables.blend_shapes) {
    shapes.push_back({name, SettledAfter(tables, [&](FaceMotion& motion) {
                        motion.Apply(0ms, settings);
                        motion.asymmetry = 0;  // left and right shapes are mirror images
                        vm::OrThrow(motion.blend_shapes.Set(0ms, name, 1, 0ms));
                      })});
  }
  return shapes;
}

FileHead MakeHeadOfFile(const std::string& path, const TableFolder& tables_folder,
                        const std::optional<UnitTable>& given_units) {
  const std::optional<UnitTable> units = given_units ? given_units : UnitsIn(tables_folder);
  FileHead made;
  if (auto own = ReadExportedHead(path)) {
    made.head = WithUnits(units, std::move(own));
    return made;
  }
  const ImportedHead file = vm::OrThrow(ReadImportedHead(path));
  made.named_files = file.named_files;
  std::vector<std::string> notices = file.notices;
  const std::string points = path + ".points";
  const Alignment alignment = AlignmentOf(file, points);
  UnriggedHead model = AlignImportedHead(file, alignment.to_ours, alignment.mouth_y);
  std::optional<RigData> skin;
  if (!file.shapes.empty()) {
    const MotionTables tables = vm::OrThrow(MotionTables::Load(tables_folder));
    BlendshapeRig own = RigOfShapes(file, alignment, tables, units, model);
    skin = std::move(own.rig);
    made.by_shapes = skin.has_value();
    if (!own.unused.empty()) {
      notices.push_back("shapes are not used, for neither ARKit nor VRM has their names: " +
                        Listed(own.unused));
    }
  }
  if (!skin && !alignment.pairs.empty()) {
    skin = TransferRig(model, *WithUnits(units, MakeHead(alignment.face)), alignment.pairs);
  }
  if (!skin) {
    notices.push_back("has no shapes with names of ARKit or VRM, and no '" + points +
                      "' says where its eyes and mouth are (face_fit --head finds out): only head, "
                      "eyes and jaw move");
  }
  for (const std::string& what : notices) {
    made.notice += (made.notice.empty() ? "'" : "; '") + path + "': " + what;
  }
  made.head = skin ? RigUnriggedHead(std::move(model), std::move(*skin))
                   : WithUnits(units, RigUnriggedHead(std::move(model)));
  return made;
}

vm::Result<void> ExportHead(const Head& head, const MotionTables& tables, const std::string& path) {
  return vm::WriteTextFile(path, WriteAsset(head, ArkitShapes(tables)));
}

}  // namespace fsm
