#include "fsm/app/more_faces.h"

#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "fsm/app/face_of_name.h"
#include "fsm/mesh/original_face.h"
#include "fsm/motion/motion_tables.h"

namespace fsm {
namespace {

std::unique_ptr<Head> MakeOriginal(const OriginalFaceFiles& files,
                                   const OriginalSharedFiles& shared, const std::string& tables) {
  const auto face = ReadOriginalFace(files, shared);
  if (!face) throw std::runtime_error("face '" + files.name + "': " + face.error().text);
  const auto motion = MotionTables::Load(tables);
  if (!motion) throw std::runtime_error(motion.error().text);
  // Its visemes are numbered as the shapes of the set of 28, but for silence, which is 0 there and
  // the last here.
  VisemeMouths mouths;
  for (std::size_t i = 0; i < kOriginalVisemes && i < motion->set28.shapes.size(); ++i) {
    mouths.push_back(motion->set28.shapes[i].pose.mouth);
  }
  MeshModel model = ModelOf(*face);
  auto moved = OwnMotionOf(*face, model, mouths);
  return MovedAsIn(tables, MakeMeshHead(std::move(model), std::move(moved)));
}

/// The first of the files that is not there; "" if all are.
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

std::vector<GlRenderBackend::Options::MoreFace> FacesOf(const OriginalConfig& config,
                                                        const std::string& tables,
                                                        std::vector<std::string>* left_out) {
  std::vector<GlRenderBackend::Options::MoreFace> faces;
  const OriginalSharedFiles shared{
      config.standard_wireframe,
      config.link,
      config.upper_teeth,
      config.lower_teeth,
      config.eye_object,
      config.mouth_picture,
      std::filesystem::path(config.standard_wireframe).parent_path().string()};
  for (const auto& mask : config.masks) {
    const OriginalFaceFiles files{mask.name,        mask.picture, mask.wireframe,
                                  mask.eye_picture, mask.eye_def, mask.teeth_def};
    if (const std::string missing = Missing(files, shared); !missing.empty()) {
      const std::string told =
          config.path + ": face '" + mask.name + "' is left out, " + missing + " is missing";
      if (left_out) {
        left_out->push_back(told);
      } else {
        std::cerr << "fsm: notice: " << told << "\n";
      }
      continue;
    }
    faces.push_back(
        {mask.name, [files, shared, tables] { return MakeOriginal(files, shared, tables); }});
  }
  return faces;
}

}  // namespace fsm
