#include "fsm/app/more_faces.h"

#include <chrono>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "fsm/app/face_of_name.h"
#include "fsm/mesh/original_expressions.h"
#include "fsm/mesh/original_face.h"
#include "fsm/motion/face_motion.h"
#include "fsm/motion/motion_tables.h"

namespace fsm {
namespace {

/// That of the offsets.
std::string FolderOf(const OriginalConfig& config) {
  return std::filesystem::path(config.standard_wireframe).parent_path().string();
}

/// What each Mouth.N asks of its parameter.
MouthUnitSizes UnitSizes(const MotionTables& tables) {
  FaceMotion motion(tables, 1);
  for (int i = 1; i <= static_cast<int>(kMouthParameters); ++i) {
    if (!motion.SetMouth(vm::Time(0), i, 1)) return {};
  }
  return motion.StateAt(std::chrono::seconds(5)).mouth;
}

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
  for (const Viseme& viseme : motion->set14.shapes) mouths.push_back(viseme.pose.mouth);
  MeshModel model = ModelOf(*face);
  RigData skin = RigOf(*face, model, mouths, UnitSizes(*motion));
  return MovedAsIn(tables, MakeMeshHead(std::move(model), std::move(skin)));
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
      config.standard_wireframe, config.link,          config.upper_teeth, config.lower_teeth,
      config.eye_object,         config.mouth_picture, FolderOf(config)};
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

void TakeExpressions(OriginalConfig& config, std::vector<std::string>* notices) {
  const auto tell = [notices](const std::string& what) {
    if (notices) {
      notices->push_back(what);
    } else {
      std::cerr << "fsm: notice: " << what << "\n";
    }
  };
  std::error_code none;
  if (!std::filesystem::exists(config.standard_wireframe, none)) return;
  const auto read = ReadOriginalExpressions(FolderOf(config), config.standard_wireframe);
  if (!read) return tell(read.error().text + "; expressions are our own");
  for (const std::string& path : read->without_rest) {
    tell(path + ": too many unlike expressions; this one is shown as far as units go");
  }
  for (const OriginalExpression& one : read->all) {
    ActionUnits look;
    for (std::size_t i = 0; i < kOriginalUnits; ++i) {
      const auto unit = static_cast<std::size_t>(kUnitNumbers[i]);
      look.right[unit] = one.right[i];
      look.left[unit] = one.left[i];
    }
    if (one.channel != kNoChannel) {
      const auto [unit, is_left] = kExpressionChannels[one.channel];
      (is_left ? look.left : look.right)[unit] = 1;
    }
    config.expressions[one.name][one.pattern] = look;
  }
}

}  // namespace fsm
