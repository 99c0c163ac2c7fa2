#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fsm/mesh/original/original_files.h"
#include "fsm/motion/face_motion.h"

namespace fsm {

/// What the original's config.txt says, as far as it means something here.
struct OriginalConfig {
  std::string path;
  std::optional<int> width, height, x, y;
  std::optional<double> expression_ms, eye_move_ms, max_frame_rate;
  std::optional<Language> language;
  std::vector<std::pair<std::string, std::string>> backgrounds;  ///< name, file, in order
  std::map<std::string, std::vector<std::string>> motions;       ///< NOD.. -> files, by pattern
  std::vector<double> blinks_ms;
  std::vector<std::pair<double, int>> auto_blinks;  ///< per cent a frame, blink pattern
  std::vector<std::string> auto_moves, auto_userdefs;

  /// In the order of their MaskFile lines, at most kMaxMasks.
  std::vector<OriginalFaceFiles> masks;
  std::vector<std::string> MaskNames() const;
  static constexpr std::size_t kMaxMasks = 100;
  OriginalSharedFiles shared;
  /// Looks of whole expressions, by FaceExp's name and pattern: those of its files
  /// (LooksOfExpressions in fsm/faces/original_faces.h). Read leaves them out.
  ExpressionLooks expressions;

  /// Reads the file: `KEY args`, `#` comments; keys it does not know mean nothing, as in the
  /// original. File names are looked for from the working directory, then from the file's own
  /// folder. Errors: those of vm::ReadTextFile; kBadValue with file and line for a damaged one.
  static vm::Result<OriginalConfig> Read(const std::string& path);

  /// Replaces the patterns the file names, and the looks above. In its movements z+ leans to the
  /// viewer's left, in ours to the right. Errors: as above, for the files it refers to.
  vm::Result<void> ApplyTo(MotionTables& tables) const;
};

}  // namespace fsm
