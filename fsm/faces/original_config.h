#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fsm/mesh/original/original_files.h"
#include "fsm/motion/face_motion.h"

namespace fsm {

/// The settings of the original's config.txt that are supported here.
struct OriginalConfig {
  std::string path;
  std::optional<int> width, height, x, y;
  std::optional<double> expression_ms, eye_move_ms, max_frame_rate;
  std::optional<Language> language;
  std::vector<std::pair<std::string, std::string>> backgrounds;  ///< name, file, in order
  /// Kind (NOD ...) -> files, indexed by pattern.
  std::map<std::string, std::vector<std::string>> motions;
  std::vector<double> blinks_ms;
  std::vector<std::pair<double, int>> auto_blinks;  ///< per cent per frame, blink pattern
  std::vector<std::string> auto_moves, auto_userdefs;

  /// In the order of their MaskFile lines, at most kMaxFaces.
  std::vector<OriginalFaceFiles> faces;
  std::vector<std::string> FaceNames() const;
  static constexpr std::size_t kMaxFaces = 100;
  OriginalSharedFiles shared;
  /// The looks of whole expressions from files (LooksOfExpressions in fsm/faces/original_faces.h).
  /// Not set by Read.
  ExpressionLooks expressions;

  /// Reads a file with lines `KEY args` and `#` comments; ignores unknown keys, as the original
  /// does. File names are relative to the working directory, or else to the file's own folder.
  /// Errors: those of vm::ReadTextFile; kBadValue with file and line for a damaged one.
  static vm::Result<OriginalConfig> Read(const std::string& path);

  /// Replaces the patterns that the file names, and the looks of `expressions`. Mirrors z of its
  /// movements, which leans to the viewer's left there and to the right here. Errors: as above, for
  /// the files it refers to.
  vm::Result<void> ApplyTo(MotionTables& tables) const;
};

}  // namespace fsm
