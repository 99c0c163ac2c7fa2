#include "fsm/app/one_shot.h"

#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "fsm/app/contact_sheet.h"
#include "fsm/asset/describe.h"
#include "fsm/faces/head_of_file.h"
#include "fsm/head/identity.h"
#include "fsm/image/image_file.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

/// Returns the faces of a sheet of identities: the one of --mask, else the built-in ones and those
/// of the command line. Faces in the user's folder are left out, because they are private and may
/// be damaged.
std::vector<std::string> FacesShown(const Options& options) {
  if (!options.module.initial_face.empty()) return {options.module.initial_face};
  std::vector<std::string> names;
  for (const NamedFace& face : options.faces) names.push_back(face.name);
  names.insert(names.end(), Identities().begin(), Identities().end());
  return names;
}

void WriteSheet(const Options& options, const MotionTables& tables, HeadLibrary& library) {
  if (options.sheet_file.empty()) throw std::runtime_error("--sheet needs --out FILE.png");
  GlFaceView::Options cell = options.view;
  cell.window_mode = GlFaceView::Options::WindowMode::kHeadless;
  cell.width = kCellWidth;
  cell.height = kCellHeight;
  GlFaceView view(library, cell);
  const auto sheet = vm::OrThrow(
      MakeSheet(options.sheet, tables, FacesShown(options), options.module.initial_face));
  const Image picture = vm::OrThrow(DrawSheet(view, library, sheet, options.labels));
  vm::OrThrow(WriteImage(picture, options.sheet_file));
}

}  // namespace

bool RunOnce(const Options& options) {
  const bool exports = !options.export_file.empty();
  if (!exports && !options.describe && options.sheet.empty()) return false;
  MotionTables tables = vm::OrThrow(MotionTables::Load(options.module.tables));
  vm::OrThrow(options.module.config.ApplyTo(tables));
  HeadLibrary library(options.faces, options.module.tables);
  if (!options.module.initial_face.empty())
    vm::OrThrow(library.Select(options.module.initial_face));
  if (options.describe) std::cout << Describe(library.head()) << std::flush;
  if (exports) vm::OrThrow(ExportHead(library.head(), tables, options.export_file));
  if (!options.sheet.empty()) WriteSheet(options, tables, library);
  return true;
}

}  // namespace fsm
