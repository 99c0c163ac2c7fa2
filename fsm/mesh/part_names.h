#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fsm/base/table_reader.h"

namespace fsm {

/// The kinds of parts of an imported head.
enum class PartKind { kSkin, kEye, kTeeth, kGum, kTongue, kMouth, kHair, kLash, kOther };

/// Classifies parts by their names, using tables/part_names.txt. Immutable; thread: any.
class PartNames {
 public:
  /// Throws TableError for a malformed row.
  explicit PartNames(const Table& table);
  static const PartNames& BuiltIn();

  /// `name`: the names of group, mesh and material, separated by anything but letters.
  PartKind KindOf(std::string_view name) const;

 private:
  struct Row {
    PartKind kind;
    std::vector<std::string> words;
  };
  std::vector<Row> rows_;
};

}  // namespace fsm
