#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/base/table_reader.h"

namespace fsm {

/// What a part of a head from elsewhere is.
enum class PartKind { kSkin, kEye, kTeeth, kGum, kTongue, kMouth, kHair, kLash, kOther };

/// Tells parts by their names, as tables/part_names.txt says. Immutable; thread: any.
class PartNames {
 public:
  /// Throws TableError for a row that is none.
  explicit PartNames(const Table& table);
  static const PartNames& BuiltIn();

  /// `name`: of group, mesh and material, with anything between them that is no letter.
  PartKind KindOf(std::string_view name) const;

 private:
  struct Row {
    PartKind kind;
    std::vector<std::string> words;
  };
  std::vector<Row> rows_;
};

}  // namespace fsm
