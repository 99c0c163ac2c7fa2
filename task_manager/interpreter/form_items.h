#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "vm_protocol/xml/node.h"

namespace vxml {

enum class ItemKind { kBlock, kInitial, kField, kRecord, kTransfer, kSubdialog, kObject, kMenu };

/// Of an event name and its beginnings up to a dot: how often it was thrown ("" counts all).
using EventCounters = std::map<std::string, int>;

/// A form item of the dialog being run (VoiceXML 2.0 section 2.3). Its form item variable is in the
/// dialog scope.
struct FormItem {
  const vm::xml::Node* node = nullptr;
  ItemKind kind = ItemKind::kBlock;
  std::string name;  ///< generated if the document gives none
  int prompt_count = 1;
  EventCounters events;
  bool over = false;  ///< a block that only <clear/> of all items lets run again
  bool IsInput() const { return kind != ItemKind::kBlock && kind != ItemKind::kInitial; }
  /// <clear> starts the counters anew.
  void ResetCounters() {
    prompt_count = 1;
    events.clear();
  }
};

/// The form or menu being run.
struct Dialog {
  const vm::xml::Node* node = nullptr;
  std::vector<FormItem> items;
  EventCounters events;
  std::string next_item;  ///< of <goto nextitem>, "" for none
  /// The items before this one are done, as long as Scopes::cleared_items() is `cleared`.
  std::size_t first_open = 0;
  std::uint64_t cleared = 0;

  FormItem* FindItem(const std::string& name) {
    for (FormItem& item : items) {
      if (item.name == name) return &item;
    }
    return nullptr;
  }
};

}  // namespace vxml
