#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/value_grammar.h"

namespace am {

/// Which slots of one module take file names, and where in their values: from what the module
/// answers to `inq Slots.files`, and for slots it does not tell of from a table of names the
/// original's modules and ours have (file_slots.txt). Pure.
///
/// Limits: kMaxSlots slots of what a module declares. If it declares more, every value of every
/// slot counts as a file name.
class FileSlots {
 public:
  static constexpr std::size_t kMaxSlots = 1024;
  /// The table alone: for modules that do not tell.
  FileSlots();
  /// `declared`: `NAME GRAMMAR; NAME GRAMMAR; ...`. Of a grammar that cannot be read every value
  /// counts as a file name.
  explicit FileSlots(std::string_view declared);

  /// True if a value of this slot can be a file name.
  bool Takes(const std::string& slot) const { return all_ || grammars_.contains(slot); }
  /// The file names in a value of this slot; the whole value where it does not fit the grammar.
  std::vector<std::string> FilesIn(const std::string& slot, const std::string& value) const;

 private:
  void Add(std::string_view entry);
  std::map<std::string, vm::ValueGrammar, std::less<>> grammars_;
  bool all_ = false;
};

}  // namespace am
