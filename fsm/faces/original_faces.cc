#include "fsm/faces/original_faces.h"

#include <filesystem>
#include <stdexcept>

#include "fsm/faces/face_of_name.h"
#include "fsm/mesh/original/convert_original_face.h"
#include "fsm/mesh/original/original_expressions.h"
#include "fsm/mesh/original/original_face.h"
#include "fsm/mesh/original/original_motion.h"
#include "fsm/mesh/rig_unrigged_head.h"
#include "fsm/motion/inputs/motion_tables.h"
#include "fsm/motion/mouth_motion.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

std::unique_ptr<Head> MakeOriginal(const OriginalFaceFiles& files,
                                   const OriginalSharedFiles& shared, const TableFolder& tables) {
  const auto face = ReadOriginalFace(files, shared);
  if (!face) throw std::runtime_error("face '" + files.name + "': " + face.error().text);
  const MotionTables motion = vm::OrThrow(MotionTables::Load(tables));
  // The original numbers its visemes as the set of 28, except silence, which is 0 there and the
  // last here.
  VisemeMouths mouths;
  for (std::size_t i = 0; i < kOriginalVisemes && i < motion.set(VisemeSetId::k28).visemes.size();
       ++i) {
    mouths.push_back(motion.set(VisemeSetId::k28).visemes[i].pose.mouth);
  }
  for (const Viseme& viseme : motion.set(VisemeSetId::k14).visemes)
    mouths.push_back(viseme.pose.mouth);
  UnriggedHead model = ConvertOriginalFace(*face);
  RigData skin = RigOfOriginal(*face, model, mouths, kMouthAtFull);
  return WithUnits(UnitsIn(tables), RigUnriggedHead(std::move(model), std::move(skin)));
}

/// Returns the first missing file; "" if none is missing.
std::string Missing(const OriginalFaceFiles& files, const OriginalSharedFiles& shared) {
  std::error_code code;
  for (const std::string* file :
       {&files.picture, &files.wireframe, &shared.standard, &shared.link}) {
    if (file->empty() || !std::filesystem::exists(*file, code)) {
      return file->empty() ? "DEF_WFM_PNT or DEF_WFM_LNK" : "'" + *file + "'";
    }
  }
  for (const std::string* file : {&files.eye_picture, &files.eye_def, &files.teeth_def}) {
    if (!file->empty() && !std::filesystem::exists(*file, code)) return "'" + *file + "'";
  }
  return "";
}

}  // namespace

OriginalFaceList OriginalFaces(std::span<const OriginalFaceFiles> faces,
                               const OriginalSharedFiles& shared, const TableFolder& tables) {
  OriginalFaceList found;
  for (const OriginalFaceFiles& files : faces) {
    const std::string missing = Missing(files, shared);
    if (missing.empty()) {
      found.faces.push_back(
          {files.name, [files, shared, tables] { return MakeOriginal(files, shared, tables); }});
    } else {
      found.left_out.push_back(shared.config + ": face '" + files.name + "' is left out, " +
                               missing + " is missing");
    }
  }
  return found;
}

ExpressionLooks LooksOfExpressions(const OriginalSharedFiles& shared, const Log& log) {
  ExpressionLooks looks;
  std::error_code none;
  if (!std::filesystem::exists(shared.standard, none)) return looks;
  const auto read = ReadOriginalExpressions(shared.offsets, shared.standard);
  if (!read) {
    log("notice: " + read.error().text + "; expressions are our own");
    return looks;
  }
  for (const std::string& path : read->without_residual) {
    log("notice: " + path + ": too many unlike expressions; this one is shown as far as units go");
  }
  for (const OriginalExpression& one : read->expressions) {
    FaceLook& look = looks[one.name][one.pattern];
    for (std::size_t i = 0; i < kOriginalUnits; ++i) {
      const auto unit = static_cast<std::size_t>(kUnitNumbers[i]);
      for (const Side side : kSides) look.au[side][unit] = one.strengths[side][i];
    }
    if (one.residual) look.residuals[*one.residual] = 1;
  }
  return looks;
}

}  // namespace fsm
