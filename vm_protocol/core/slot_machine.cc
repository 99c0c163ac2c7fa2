#include "vm_protocol/core/slot_machine.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "vm_protocol/core/blanks.h"
#include "vm_protocol/core/limits.h"
#include "vm_protocol/core/nearest_word.h"
#include "vm_protocol/core/slot.h"
#include "vm_protocol/core/utf8.h"

namespace vm {
namespace {

constexpr std::string_view kErrorSlot = "Error";
constexpr std::size_t kShownLineBytes = 200;  // of a refused line, for the log

std::string JoinLines(std::string_view text) {
  std::string joined;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!joined.empty() && !line.empty()) joined += ' ';
    joined += line;
    at = end + 1;
  }
  return joined;
}

std::string Place(const Message& message) {
  return message.slot.empty() ? std::string(CommandName(message.command)) : message.slot;
}

}  // namespace

struct Reply::Shared {
  Function function;
};

Reply::Reply(Function function) : shared_(std::make_shared<Shared>(Shared{std::move(function)})) {}
void Reply::Ok(std::string value) const {
  if (auto function = std::exchange(shared_->function, nullptr)) function(std::move(value));
}
void Reply::Fail(Error error) const {
  if (auto function = std::exchange(shared_->function, nullptr)) {
    function(std::unexpected(std::move(error)));
  }
}
bool Reply::done() const { return shared_->function == nullptr; }

SlotMachine::SlotMachine(std::string module_name)
    : module_name_(std::move(module_name)), alive_(std::make_shared<bool>(true)) {
  DeclareOwnSlots();
}
SlotMachine::~SlotMachine() { *alive_ = false; }

void SlotMachine::DeclareOwnSlots() {
  Declare({.name = "Slots",
           .grammar = "<text>",
           .access = Access::kReadOnly,
           .help = "The names of all slots of this module, separated by blanks. "
                   "`inq NAME.help` explains one, `inq NAME.prop` tells its attributes.",
           .on_inq = [this] {
             std::string names;
             for (const auto& slot : slots_) names += (names.empty() ? "" : " ") + slot->spec.name;
             return names;
           }});
  Declare({.name = "Slots.files",
           .grammar = "<text>",
           .access = Access::kReadOnly,
           .help = "The slots that take file names, with their grammars: NAME GRAMMAR; NAME "
                   "GRAMMAR; ... A hub asks for it, to know who may set them.",
           .on_inq = [this] {
             std::string text;
             for (const auto& slot : slots_) {
               if (slot->spec.access != Access::kReadOnly && slot->grammar.has_file())
                 text += (text.empty() ? "" : "; ") + slot->spec.name + " " + slot->spec.grammar;
             }
             return text;
           }});
  Declare({.name = std::string(kErrorSlot),
           .grammar = "<text>",
           .access = Access::kReadOnly,
           .help =
               "The last error, as CODE and text. `prop Error = AutoOutput` has every refusal "
               "reported to you as `rep SLOT.error = CODE text`, also for lines without a tag."});
}

void SlotMachine::set_output(Output output) { output_ = std::move(output); }
void SlotMachine::set_read_file(ReadFile read_file) { read_file_ = std::move(read_file); }
void SlotMachine::set_append_file(AppendFile append_file) { append_file_ = std::move(append_file); }
void SlotMachine::set_on_error(OnError on_error) { on_error_ = std::move(on_error); }
void SlotMachine::set_on_heard(OnHeard on_heard) { on_heard_ = std::move(on_heard); }
void SlotMachine::set_exit_gate(ExitGate exit_gate) { exit_gate_ = std::move(exit_gate); }
void SlotMachine::set_definition_hook(Hook hook) { definition_hook_ = std::move(hook); }
void SlotMachine::AddShortcut(std::string line, std::string replacement) {
  shortcuts_[std::move(line)] = std::move(replacement);
}

void SlotMachine::Declare(SlotSpec spec) {
  assert(IsSlotName(spec.name) && !Find(spec.name));
  slots_.push_back(std::make_unique<Slot>(std::move(spec)));
  by_name_[slots_.back()->spec.name] = slots_.back().get();
}

void SlotMachine::DeclareTold(std::string name, std::string initial, std::string help,
                              bool auto_output) {
  Declare({.name = std::move(name),
           .grammar = "<text>",
           .access = Access::kReadOnly,
           .initial = std::move(initial),
           .auto_output = auto_output,
           .help = std::move(help)});
}

void SlotMachine::Reserve(std::string beginning) { reserved_.push_back(std::move(beginning)); }

void SlotMachine::Remove(std::string_view name) {
  const auto found = by_name_.find(name);
  if (found == by_name_.end()) return;
  std::erase_if(slots_, [slot = found->second](const auto& owned) { return owned.get() == slot; });
  by_name_.erase(found);
}

SlotMachine::Slot* SlotMachine::Find(std::string_view name) {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? nullptr : found->second;
}
const SlotMachine::Slot* SlotMachine::Find(std::string_view name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? nullptr : found->second;
}
bool SlotMachine::Has(std::string_view slot) const { return Find(slot) != nullptr; }

void SlotMachine::HandleLine(std::string_view line, PeerId peer) {
  if (const auto found = shortcuts_.find(line); found != shortcuts_.end()) line = found->second;
  auto message = ParseMessage(line);
  if (!message) {
    if (message.error().code == Errc::kEmpty) return;
    if (on_error_) on_error_(peer, ShownUtf8(CutUtf8(line, kShownLineBytes)), message.error());
    if (const std::string tag = TagOf(line); !tag.empty())
      return RefuseTagged(std::string(kErrorSlot), tag, peer, message.error());
    ReportUnread(peer, message.error());
    return;
  }
  Handle(*message, peer);
}

void SlotMachine::Handle(const Message& message, PeerId peer) {
  switch (message.command) {
    case Command::kSet:
      return HandleSet(message, peer);
    case Command::kInq:
      return HandleInq(message, peer);
    case Command::kProp:
      return HandleProp(message, peer);
    case Command::kSave:
      return HandleSave(message, peer);
    case Command::kRest:
      return HandleRest(message, peer);
    case Command::kDef:
      return HandleDef(message, peer);
    case Command::kDel:
      return HandleDel(message, peer);
    case Command::kDo:
      return HandleDo(message, peer);
    case Command::kRep:
    case Command::kTell:
      if (on_heard_) on_heard_(message);  // else: not for a plain slot machine
      return;
  }
}

Reply SlotMachine::MakeReply(const Message& message, PeerId peer) {
  return Reply(
      [this, message, peer, alive = std::weak_ptr<bool>(alive_)](Result<std::string> result) {
        const auto still = alive.lock();
        if (!still || !*still) return;
        if (result) {
          Answer(message, peer, std::move(*result));
        } else {
          Refuse(message, peer, result.error());
        }
      });
}

void SlotMachine::Answer(const Message& message, PeerId peer, std::string value) {
  if (message.tag.empty()) return;
  Message answer = Rep(Place(message), std::move(value));
  if (message.command == Command::kDo && message.slot.empty()) answer.slot = "do";
  answer.tag = message.tag;
  Emit(peer, std::move(answer));
}

Result<std::string> SlotMachine::ResolveValue(const Message& message, const std::string& present) {
  if (message.relation == Relation::kFromFile) {
    if (!read_file_) return Fail(Errc::kUnavailable, "files cannot be read here");
    auto text = read_file_(message.value);
    if (!text) return std::unexpected(text.error());
    std::string joined = JoinLines(*text);
    if (joined.size() > kMaxLineBytes) {
      return Fail(Errc::kTooLong, "file '" + message.value + "' holds " +
                                      std::to_string(joined.size()) + " bytes, expected at most " +
                                      std::to_string(kMaxLineBytes));
    }
    return joined;
  }
  if (message.relation != Relation::kAppend || present.empty()) return message.value;
  if (present.size() + 1 + message.value.size() > kMaxLineBytes)
    return Fail(Errc::kTooLong,
                "the value would be over " + std::to_string(kMaxLineBytes) + " bytes");
  return present + " " + message.value;
}

void SlotMachine::HandleSet(const Message& message, PeerId peer) {
  Slot* slot = Find(message.slot);
  if (slot == nullptr) return Refuse(message, peer, UnknownSlot(message.slot));
  if (slot->spec.access == Access::kReadOnly) {
    return Refuse(message, peer,
                  {Errc::kAccess, "slot '" + message.slot + "' can only be asked (inq)", 0});
  }
  auto text = ResolveValue(message, slot->value);
  if (!text) return Refuse(message, peer, text.error());
  // A blank at the end is part of a text only, not of a word, a number or a file's name.
  if (!slot->grammar.has_text()) {
    while (!text->empty() && IsBlank(text->back())) text->pop_back();
  }
  auto items = slot->grammar.Match(*text);
  if (!items) return Refuse(message, peer, items.error());
  SetValue value{std::move(*text), std::move(*items), slot->spec.name, peer};
  const bool exits = slot->spec.name == "Run" && value.size() == 1 && value.word(0) == "EXIT";
  if (!exits || !exit_gate_) return Perform(message, value);
  exit_gate_([this, message, value = std::move(value)] { Perform(message, value); });
}

void SlotMachine::Perform(const Message& message, const SetValue& value) {
  const PeerId peer = value.peer;
  Slot* slot = Find(message.slot);
  if (slot == nullptr) return Refuse(message, peer, UnknownSlot(message.slot));
  if (slot->spec.on_set_later) {
    slot->spec.on_set_later(value, MakeReply(message, peer));
    return;
  }
  Result<std::string> stored = value.text;
  if (slot->spec.on_set) stored = slot->spec.on_set(value);
  if (stored && slot->user_made) {
    if (const auto kept = Keep(slot->value.size(), stored->size()); !kept)
      stored = std::unexpected(kept.error());
  }
  if (!stored) return Refuse(message, peer, stored.error());
  // The action may have deleted the slot.
  if (Has(message.slot)) Report(message.slot, *stored);
  Answer(message, peer, std::move(*stored));
}

void SlotMachine::HandleInq(const Message& message, PeerId peer) {
  const auto answer = [&](std::string_view slot_name, std::string value, bool quoted) {
    Message rep = Rep(std::string(slot_name), quoted ? "\"" + value + "\"" : std::move(value));
    rep.tag = message.tag;
    Emit(peer, std::move(rep));
  };
  const std::string_view name = message.slot;
  if (const Slot* slot = Find(name)) {
    if (slot->spec.access == Access::kWriteOnly && slot->spec.group.empty()) {
      return Refuse(message, peer,
                    {Errc::kAccess, "slot '" + message.slot + "' can only be set", 0});
    }
    for (const auto& members : {slot->spec.group, slot->spec.told_with_group}) {
      for (const std::string& member : members)
        answer(member, Value(member), Find(member)->spec.quoted);
    }
    // A group that has no value of its own says it only to a tagged question, which needs an end.
    if (slot->spec.group.empty() || slot->spec.access != Access::kWriteOnly ||
        !message.tag.empty()) {
      answer(name, Value(name), slot->spec.quoted);
    }
    return;
  }
  const std::size_t dot = name.rfind('.');
  const Slot* parent = dot == std::string_view::npos ? nullptr : Find(name.substr(0, dot));
  if (parent != nullptr && name.substr(dot + 1) == "help") {
    return answer(name, parent->Help(), false);
  }
  if (parent != nullptr && name.substr(dot + 1) == "prop") {
    return answer(name, parent->Attributes(), false);
  }
  Refuse(message, peer, UnknownSlot(message.slot));
}

void SlotMachine::HandleProp(const Message& message, PeerId peer) {
  const bool on = message.value == "AutoOutput";
  if (!on && message.value != "NoAutoOutput") {
    return Refuse(
        message, peer,
        {Errc::kBadValue, "found '" + message.value + "', expected AutoOutput or NoAutoOutput", 1});
  }
  Slot* slot = Find(message.slot);
  if (slot == nullptr) return Refuse(message, peer, UnknownSlot(message.slot));
  if (message.slot == kErrorSlot) {
    std::erase(error_peers_, peer);
    if (on && error_peers_.size() >= kMaxErrorPeers) {
      return Refuse(message, peer,
                    {Errc::kLimit,
                     "more than " + std::to_string(kMaxErrorPeers) + " peers ask for errors", 0});
    }
    if (on) error_peers_.push_back(peer);
  }
  slot->auto_output = on;
  for (const std::string& member : slot->spec.group) Find(member)->auto_output = on;
  Answer(message, peer, message.value);
}

void SlotMachine::Report(std::string_view slot_name, std::string value) {
  Slot* slot = Find(slot_name);
  assert(slot != nullptr);
  slot->value = std::move(value);
  if (!slot->auto_output) return;
  Emit(kEveryone,
       Rep(slot->spec.name, slot->spec.quoted ? "\"" + slot->value + "\"" : slot->value));
}

void SlotMachine::Store(std::string_view slot_name, std::string value) {
  Slot* slot = Find(slot_name);
  assert(slot != nullptr);
  slot->value = std::move(value);
}

void SlotMachine::StoreInitialValues() {
  for (const auto& slot : slots_) {
    if (!slot->user_made && slot->spec.name != kErrorSlot) slot->value = slot->spec.initial;
  }
}

std::string SlotMachine::Value(std::string_view slot_name) const {
  const Slot* slot = Find(slot_name);
  assert(slot != nullptr);
  return slot->spec.on_inq ? slot->spec.on_inq() : slot->value;
}

bool SlotMachine::AutoOutput(std::string_view slot_name) const {
  const Slot* slot = Find(slot_name);
  return slot != nullptr && slot->auto_output;
}

void SlotMachine::Say(Message message) { Emit(kEveryone, std::move(message)); }

void SlotMachine::TellAll(std::string text) { Emit(kEveryone, Tell(std::move(text))); }

void SlotMachine::ReportError(std::string_view slot, const Error& error) {
  if (on_error_) on_error_(kEveryone, std::string(slot), error);
  ReportUnread(kEveryone, error, slot);
}

void SlotMachine::ReportUnread(PeerId peer, const Error& error, std::string_view slot) {
  Store(kErrorSlot, FormatError(error));
  Message rep = Rep(slot.empty() ? std::string(kErrorSlot) : std::string(slot) + ".error",
                    FormatError(error));
  const auto wanting_it = error_peers_;  // a copy: one of them may go while it is told
  for (const PeerId wanting : wanting_it) {
    if (peer == kEveryone || wanting == kEveryone || wanting == peer) Emit(wanting, rep);
  }
}

void SlotMachine::Refuse(const Message& message, PeerId peer, const Error& error) {
  if (on_error_)
    on_error_(peer, ShownUtf8(CutUtf8(FormatMessage(message), kShownLineBytes)), error);
  const std::string slot = Place(message);
  if (message.tag.empty()) return ReportUnread(peer, error, slot);
  RefuseTagged(slot + ".error", message.tag, peer, error);
}

void SlotMachine::RefuseTagged(const std::string& place, const std::string& tag, PeerId peer,
                               const Error& error) {
  Store(kErrorSlot, FormatError(error));
  Message answer = Rep(place, FormatError(error));
  answer.tag = tag;
  Emit(peer, std::move(answer));
}

std::string SlotMachine::GuessValue(const std::string& name) const {
  std::vector<std::string> words;
  std::vector<const Slot*> takers;  // of each of them
  for (const auto& slot : slots_) {
    if (slot->spec.access == Access::kReadOnly) continue;
    for (std::string& word : slot->grammar.Words()) words.push_back(std::move(word));
    takers.resize(words.size(), slot.get());
  }
  const std::string_view nearest = NearestWord(name, words);
  if (nearest.empty() || nearest.size() > name.size() + 1) return "";
  const auto at = static_cast<std::size_t>(std::ranges::find(words, nearest) - words.begin());
  return ", did you mean '" + takers[at]->spec.name + " = " + words[at] + "'?";
}

Error SlotMachine::UnknownSlot(const std::string& name) const {
  std::vector<std::string> names;
  for (const auto& slot : slots_) names.push_back(slot->spec.name);
  std::string guess = DidYouMean(name, names);
  if (guess.empty()) guess = GuessValue(name);
  return {Errc::kUnknownSlot,
          "module " + module_name_ + " has no slot '" + name + "'" +
              (guess.empty() ? " (inq Slots lists them)" : guess),
          0};
}

Result<void> SlotMachine::Keep(std::size_t before, std::size_t after) {
  const std::size_t kept = kept_bytes_ - std::min(before, kept_bytes_) + after;
  if (after > before && kept > kMaxKeptBytes) {
    return Fail(Errc::kLimit,
                "what def and save keep would be over " + std::to_string(kMaxKeptBytes) + " bytes");
  }
  kept_bytes_ = kept;
  return {};
}

void SlotMachine::Emit(PeerId peer, Message message) {
  // What is said must be readable: one line of text, also behind the "From @NAME " of a hub.
  constexpr std::size_t kRoom = 2 * kMaxModuleNameBytes + 8;
  std::string& value = message.value;
  if (value.find_first_of(std::string_view("\0\r\n", 3)) != std::string::npos ||
      FirstBadUtf8(value)) {
    value = ShownUtf8(value);
  }
  if (value.size() > kMaxLineBytes / 2) {
    const std::size_t line = FormatMessage(message).size() + kRoom;
    if (line > kMaxLineBytes) value = CutUtf8(value, value.size() - (line - kMaxLineBytes));
  }
  if (output_) output_(peer, message);
}

void SlotMachine::PeerGone(PeerId peer) { std::erase(error_peers_, peer); }

}  // namespace vm
