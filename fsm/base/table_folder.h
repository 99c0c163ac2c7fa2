#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vm_protocol/core/result.h"

namespace fsm {

/// A folder whose files replace tables that are built into the program: a file replaces the table
/// of the same name if that is one of kTables. A plain value; thread: any.
class TableFolder {
 public:
  static constexpr std::string_view kUnits = "action_units.txt", kAppearance = "appearance.txt",
                                    kFeatures = "features.txt",
                                    kUnitNames = "action_unit_names.txt";
  /// The tables that can be replaced, in alphabetical order.
  static constexpr std::array kTables = std::to_array<std::string_view>({"action_unit_list.txt",
                                                                         kUnitNames,
                                                                         kUnits,
                                                                         kAppearance,
                                                                         "arkit.txt",
                                                                         "dominance.txt",
                                                                         "emotion_space.txt",
                                                                         "emotions.txt",
                                                                         kFeatures,
                                                                         "gestures.txt",
                                                                         "mixing.txt",
                                                                         "motions.txt",
                                                                         "mouth_shapes.txt",
                                                                         "mouth_shapes_28.txt",
                                                                         "phoneme_names.txt",
                                                                         "phonemes28_en.txt",
                                                                         "phonemes28_ja.txt",
                                                                         "phonemes_en.txt",
                                                                         "phonemes_ja.txt",
                                                                         "text_cues.txt"});

  /// With an empty `path` no table is replaced. Implicit: a path is a folder.
  TableFolder(std::string path = {}) : path_(std::move(path)) {}
  TableFolder(const char* path) : path_(path) {}

  struct File {
    std::string path, text;
  };
  /// Returns the file that replaces `table`, one of kTables (REQUIRED), or nothing if there is
  /// none. Errors: kUnavailable if the folder or the file cannot be read; those of ReadTableFile.
  vm::Result<std::optional<File>> Find(std::string_view table) const;
  /// Returns the folder's files that replace no table, sorted; hidden files are left out.
  std::vector<std::string> UnknownFiles() const;
  const std::string& path() const { return path_; }
  bool empty() const { return path_.empty(); }

 private:
  std::string path_;
};

}  // namespace fsm
