// The commands which the original named but left empty: save, rest, def, del, do.
// What they mean here is written in docs/protocol.md.

#include <algorithm>
#include <utility>

#include "vm_protocol/core/limits.h"
#include "vm_protocol/core/slot.h"

namespace vm {
namespace {

std::vector<std::string> Words(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at < text.size();) {
    at = text.find_first_not_of(" \t", at);
    if (at == std::string_view::npos) break;
    const std::size_t end = std::min(text.find_first_of(" \t", at), text.size());
    words.emplace_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

std::vector<std::string> Lines(std::string_view text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.emplace_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

constexpr std::size_t kEntryBytes = 64;  // what an entry takes beside its text, roughly

using Values = std::vector<std::pair<std::string, std::string>>;
std::size_t BytesOf(const Values& values) {
  std::size_t bytes = kEntryBytes;
  for (const auto& [name, value] : values) bytes += 2 * kEntryBytes + name.size() + value.size();
  return bytes;
}
std::size_t BytesOf(const std::vector<std::string>& lines) {
  std::size_t bytes = kEntryBytes;
  for (const std::string& line : lines) bytes += kEntryBytes + line.size();
  return bytes;
}
/// What is kept under a name, 0 if nothing is.
template <typename Map>
std::size_t BytesKept(const Map& map, const std::string& name) {
  const auto found = map.find(name);
  return found == map.end() ? 0 : BytesOf(found->second);
}

}  // namespace

void SlotMachine::HandleSave(const Message& message, PeerId peer) {
  std::vector<std::string> names;
  if (message.relation == Relation::kAssign) {
    names = Words(message.value);
  } else {
    for (const auto& slot : slots_) {
      if (slot->spec.access == Access::kReadWrite && slot->spec.saved)
        names.push_back(slot->spec.name);
    }
  }
  Values values;
  for (const std::string& name : names) {
    const Slot* slot = Find(name);
    if (slot == nullptr) return Refuse(message, peer, UnknownSlot(name));
    if (slot->spec.access != Access::kReadWrite) {
      return Refuse(message, peer,
                    {Errc::kAccess, "slot '" + name + "' cannot be both asked and set", 0});
    }
    values.emplace_back(name, Value(name));
  }
  if (message.relation == Relation::kAppend) {  // save NAME << FILE: as lines which `do FILE` runs
    if (!append_file_)
      return Refuse(message, peer, {Errc::kUnavailable, "files cannot be written here", 0});
    std::string text = "# saved set " + message.slot + "\n";
    for (const auto& [name, value] : values) text += FormatMessage(Set(name, value)) + "\n";
    if (const auto written = append_file_(message.value, text); !written) {
      return Refuse(message, peer, written.error());
    }
  } else if (!saved_.contains(message.slot) && saved_.size() >= kMaxSavedSets) {
    return Refuse(message, peer,
                  {Errc::kLimit, "more than " + std::to_string(kMaxSavedSets) + " saved sets", 0});
  }
  if (const auto kept = Keep(BytesKept(saved_, message.slot), BytesOf(values)); !kept)
    return Refuse(message, peer, kept.error());
  const std::string count = std::to_string(values.size()) + " slots";
  saved_[message.slot] = std::move(values);
  Answer(message, peer, count);
}

void SlotMachine::HandleRest(const Message& message, PeerId peer) {
  const auto found = saved_.find(message.slot);
  if (found == saved_.end()) {
    return Refuse(message, peer,
                  {Errc::kUnknownSlot, "nothing was saved as '" + message.slot + "'", 0});
  }
  const auto values = found->second;  // a copy: setting may run anything
  for (const auto& [name, value] : values) {
    if (Has(name) && Value(name) != value) Handle(Set(name, value), peer);
  }
  Answer(message, peer, std::to_string(values.size()) + " slots");
}

Result<void> SlotMachine::DefineMacroLines(const Message& message) {
  std::vector<std::string> more{message.value};
  if (message.relation == Relation::kFromFile) {
    if (!read_file_) return Fail(Errc::kUnavailable, "files cannot be read here");
    const auto text = read_file_(message.value);
    if (!text) return std::unexpected(text.error());
    more = Lines(*text);
  }
  for (std::size_t i = 0; i < more.size(); ++i) {
    const auto parsed = ParseMessage(more[i]);
    if (!parsed && parsed.error().code != Errc::kEmpty) {
      return Fail(parsed.error().code,
                  "line " + std::to_string(i + 1) + " of macro '" + message.slot +
                      "': " + parsed.error().text,
                  parsed.error().column);
    }
  }
  if (message.relation == Relation::kAppend) {
    if (const auto made = macros_.find(message.slot); made != macros_.end())
      more.insert(more.begin(), made->second.begin(), made->second.end());
  }
  if (more.size() > kMaxMacroLines) {
    return Fail(Errc::kLimit, "macro '" + message.slot + "' would have more than " +
                                  std::to_string(kMaxMacroLines) + " lines");
  }
  if (auto kept = Keep(BytesKept(macros_, message.slot), BytesOf(more)); !kept) return kept;
  macros_[message.slot] = std::move(more);
  return {};
}

Result<void> SlotMachine::DefineUserSlot(const Message& message) {
  if (Slot* slot = Find(message.slot)) {
    if (!slot->user_made) {
      return Fail(Errc::kAccess,
                  "slot '" + message.slot + "' belongs to the module, it cannot be defined anew");
    }
    if (auto kept = Keep(slot->value.size(), message.value.size()); !kept) return kept;
    slot->value = message.value;
    return {};
  }
  for (const std::string& beginning : reserved_) {
    if (message.slot.starts_with(beginning))
      return Fail(Errc::kAccess, "slot '" + message.slot +
                                     "' cannot be defined: names that begin " + "with '" +
                                     beginning + "' are the module's own");
  }
  if (user_slots_ >= kMaxUserSlots) {
    return Fail(Errc::kLimit, "more than " + std::to_string(kMaxUserSlots) + " user slots");
  }
  if (auto kept = Keep(0, kEntryBytes + message.value.size()); !kept) return kept;
  Declare({.name = message.slot,
           .grammar = "<text>",
           .initial = message.value,
           .help = "Made by def."});
  Find(message.slot)->user_made = true;
  ++user_slots_;
  return {};
}

void SlotMachine::HandleDef(const Message& message, PeerId peer) {
  if (definition_hook_ && definition_hook_(message, peer, MakeReply(message, peer))) return;
  Result<void> done;
  if (message.relation == Relation::kAssign) {
    done = DefineUserSlot(message);
  } else if (message.relation == Relation::kNone) {
    done = Fail(Errc::kBadValue,
                "expected `def NAME = VALUE` (a slot) or `def NAME << LINE` (a macro)");
  } else {
    done = DefineMacroLines(message);
  }
  if (!done) return Refuse(message, peer, done.error());
  Answer(message, peer, message.value);
}

void SlotMachine::HandleDel(const Message& message, PeerId peer) {
  if (definition_hook_ && definition_hook_(message, peer, MakeReply(message, peer))) return;
  (void)Keep(BytesKept(macros_, message.slot) + BytesKept(saved_, message.slot), 0);
  bool removed = macros_.erase(message.slot) > 0;
  removed |= saved_.erase(message.slot) > 0;
  if (Slot* slot = Find(message.slot)) {
    if (!slot->user_made) {
      return Refuse(message, peer,
                    {Errc::kAccess,
                     "slot '" + message.slot + "' belongs to the module, it cannot be deleted", 0});
    }
    (void)Keep(kEntryBytes + slot->value.size(), 0);
    Remove(message.slot);
    --user_slots_;
    removed = true;
  }
  if (!removed) {
    return Refuse(message, peer,
                  {Errc::kUnknownSlot, "nothing defined or saved as '" + message.slot + "'", 0});
  }
  Answer(message, peer, "deleted");
}

void SlotMachine::HandleDo(const Message& message, PeerId peer) {
  if (definition_hook_ && definition_hook_(message, peer, MakeReply(message, peer))) return;
  std::vector<std::string> lines;
  if (const auto macro = macros_.find(message.slot);
      !message.slot.empty() && macro != macros_.end()) {
    lines = macro->second;
  } else {
    const std::string path = message.slot.empty() ? message.value : message.slot;
    if (!read_file_)
      return Refuse(message, peer, {Errc::kUnavailable, "files cannot be read here", 0});
    const auto text = read_file_(path);
    if (!text) {
      return Refuse(
          message, peer,
          {text.error().code, "no macro '" + path + "', and as a file: " + text.error().text, 0});
    }
    lines = Lines(*text);
    if (lines.size() > kMaxMacroLines) {
      return Refuse(
          message, peer,
          {Errc::kLimit,
           "file '" + path + "' has more than " + std::to_string(kMaxMacroLines) + " lines", 0});
    }
  }
  if (depth_ >= kMaxMacroDepth) {
    return Refuse(message, peer,
                  {Errc::kLimit,
                   "`do` within `do` more than " + std::to_string(kMaxMacroDepth) + " deep", 0});
  }
  if (depth_ == 0) lines_run_ = 0;
  ++depth_;
  std::size_t done = 0;
  for (; done < lines.size() && lines_run_ < kMaxDoLines; ++done) {
    ++lines_run_;
    HandleLine(lines[done], peer);
  }
  --depth_;
  if (done < lines.size()) {
    return Refuse(message, peer,
                  {Errc::kLimit, "stopped after " + std::to_string(kMaxDoLines) + " lines", 0});
  }
  Answer(message, peer, std::to_string(lines.size()) + " lines");
}

}  // namespace vm
