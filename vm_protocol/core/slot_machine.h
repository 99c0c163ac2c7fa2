#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/message.h"
#include "vm_protocol/core/result.h"
#include "vm_protocol/core/value_grammar.h"

namespace vm {

/// Who asked. 0 is nobody in particular: output for it goes to every peer.
using PeerId = unsigned;
inline constexpr PeerId kEveryone = 0;

enum class Access {
  kReadOnly,   ///< `inq` only
  kReadWrite,  ///< `inq` and `set`
  kWriteOnly,  ///< `set` only: an action; `inq` is refused
};

class SlotMachine;

/// An answer that may be given later. Copyable; the first call wins, later ones are ignored.
/// Every tagged request is answered exactly once: success `rep#TAG Slot = VALUE`, refusal
/// `rep#TAG Slot.error = CODE text`. Untagged requests are answered only by failure.
class Reply {
 public:
  using Function = std::function<void(Result<std::string>)>;
  explicit Reply(Function function);
  void Ok(std::string value) const;
  void Fail(Error error) const;
  bool done() const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

/// The value of a `set`, matched against the slot's grammar.
struct SetValue {
  std::string text;           ///< as it came (for <text>: the whole rest of the line)
  ValueGrammar::Items items;  ///< taken apart
  std::string slot;           ///< the slot's full name (for actions shared by several slots)
  PeerId peer = kEveryone;    ///< who asked

  const std::string& word(std::size_t i) const { return items.at(i).text; }
  double number(std::size_t i) const { return items.at(i).number; }
  std::size_t size() const { return items.size(); }
};

/// One slot, declared. Everything the outside can learn or do about it is here.
struct SlotSpec {
  std::string name{};     ///< "Speak.stat"
  std::string grammar{};  ///< see ValueGrammar; shown to people
  Access access = Access::kReadWrite;
  std::string initial{};     ///< the value at start (not run through on_set)
  bool auto_output = false;  ///< whether changes are reported from the start
  std::string help{};        ///< one or two sentences; unit and range

  /// Called with a value that fits. Empty = just store it. Returns the value to store (and report),
  /// or an error; the slot then keeps its value.
  std::function<Result<std::string>(const SetValue&)> on_set{};
  /// Instead of on_set where the answer comes later or nothing is to be stored.
  std::function<void(const SetValue&, Reply)> on_set_later{};
  /// Computes the value for `inq`. Empty = what is stored.
  std::function<std::string()> on_inq{};

  bool quoted = false;  ///< answers carry "..." around the value, as some of the original's do
  bool saved = true;    ///< part of `save NAME` without a list (read-write slots only)
  /// Names of slots which `inq` of this one also lists, before itself, and which `prop` reaches.
  std::vector<std::string> group{};
  std::vector<std::string> told_with_group{};  ///< which `inq` lists too, but `prop` leaves alone
};

/// The slots of one virtual machine and everything that can be said to them. Pure: no I/O, no
/// clock; output goes to the callback. Gives every module, without code of its own:
///   inq Slots, inq Slots.files, inq X.help, inq X.prop; prop X = AutoOutput|NoAutoOutput, prop
///   Error = AutoOutput; save/rest NAME; def/del of user slots; `<` and `<<`; def NAME << LINE and
///   do NAME (macros).
/// Thread: none of its own; one instance, one thread. Callbacks may call Report() and Handle().
class SlotMachine {
 public:
  /// `peer` is kEveryone, or the one peer an answer is for.
  using Output = std::function<void(PeerId peer, const Message& message)>;
  /// Reads a file for `<` and `do FILE`; injected so that tests have a world in memory.
  using ReadFile = std::function<Result<std::string>(const std::string& path)>;
  using AppendFile = std::function<Result<void>(const std::string& path, const std::string& text)>;
  /// Told of every error, for stderr and for the exit code.
  using OnError = std::function<void(PeerId peer, const std::string& line, const Error& error)>;

  explicit SlotMachine(std::string module_name);
  ~SlotMachine();
  SlotMachine(const SlotMachine&) = delete;

  void set_output(Output output);
  void set_read_file(ReadFile read_file);
  void set_append_file(AppendFile append_file);
  void set_on_error(OnError on_error);
  /// Asked before `def`, `del` and `do` are handled here: true = the module has dealt with it.
  /// (So a module can define its own kinds of things.)
  using Hook = std::function<bool(const Message& message, PeerId peer, Reply reply)>;
  void set_definition_hook(Hook hook);
  /// Told of what other modules say to this one: `rep` and `tell`, as answers to what Say asked.
  /// Without it they are passed over.
  using OnHeard = std::function<void(const Message& message)>;
  void set_on_heard(OnHeard on_heard);
  /// Given what `set Run = EXIT` does, to be called at once or when what was said before is done.
  using ExitGate = std::function<void(std::function<void()> exit)>;
  void set_exit_gate(ExitGate exit_gate);
  /// Lines to be replaced before parsing, as the original's one-letter shortcuts.
  void AddShortcut(std::string line, std::string replacement);

  /// REQUIRES: the name is new and valid; the grammar is well-formed.
  void Declare(SlotSpec spec);
  /// Declares a slot of text that only the module changes.
  void DeclareTold(std::string name, std::string initial, std::string help,
                   bool auto_output = false);
  /// Names that begin so are for later Declare calls: `def` makes no user slot of such a name.
  void Reserve(std::string beginning);
  /// Takes a slot back. Not from within one of its own callbacks.
  void Remove(std::string_view slot);
  bool Has(std::string_view slot) const;

  /// Deals with one line from a peer: parses, checks, acts, answers. Never throws on bad input.
  void HandleLine(std::string_view line, PeerId peer = kEveryone);
  void Handle(const Message& message, PeerId peer = kEveryone);

  /// Stores a slot's new value and, if the slot has AutoOutput, reports it to everyone.
  /// REQUIRES: the slot is declared.
  void Report(std::string_view slot, std::string value);
  /// Stores without reporting.
  void Store(std::string_view slot, std::string value);
  /// Gives every slot of the module its SlotSpec::initial again, without reporting, but for Error.
  /// Slots that users have defined keep their values.
  void StoreInitialValues();
  std::string Value(std::string_view slot) const;  ///< as `inq` would say it, unquoted
  bool AutoOutput(std::string_view slot) const;
  /// `tell TEXT` to everyone.
  void TellAll(std::string text);
  /// A message of this module's own, as to another module by the hub (vm::To). REQUIRES: IsValid.
  void Say(Message message);
  /// An error not tied to a request in hand: `rep SLOT.error = CODE text` where Error reports are
  /// on, and OnError. `slot` may be empty.
  void ReportError(std::string_view slot, const Error& error);
  /// Forget a peer that has gone (late replies to it are dropped).
  void PeerGone(PeerId peer);

  const std::string& module_name() const { return module_name_; }
  /// The table of slots in Markdown, for docs/reference/slots.md.
  std::string DocsMarkdown() const;

 private:
  struct Slot;
  void DeclareOwnSlots();
  Slot* Find(std::string_view name);
  const Slot* Find(std::string_view name) const;
  void Emit(PeerId peer, Message message);
  void Refuse(const Message& message, PeerId peer, const Error& error);
  void RefuseTagged(const std::string& place, const std::string& tag, PeerId peer,
                    const Error& error);
  void HandleSet(const Message& message, PeerId peer);
  void Perform(const Message& message, const SetValue& value);
  void HandleInq(const Message& message, PeerId peer);
  void HandleProp(const Message& message, PeerId peer);
  void HandleSave(const Message& message, PeerId peer);
  void HandleRest(const Message& message, PeerId peer);
  void HandleDef(const Message& message, PeerId peer);
  void HandleDel(const Message& message, PeerId peer);
  void HandleDo(const Message& message, PeerId peer);
  void Answer(const Message& message, PeerId peer, std::string value);
  Reply MakeReply(const Message& message, PeerId peer);
  Result<std::string> ResolveValue(const Message& message, const std::string& present);
  Result<void> DefineMacroLines(const Message& message);
  Result<void> DefineUserSlot(const Message& message);
  void ReportUnread(PeerId peer, const Error& error, std::string_view slot = {});
  /// Accounts for something kept for users that grows or shrinks. kLimit over kMaxKeptBytes.
  Result<void> Keep(std::size_t before, std::size_t after);
  Error UnknownSlot(const std::string& name) const;
  /// For the end of an error's text: whoever wrote a word that is a value may have meant the slot
  /// that takes it. Empty: none.
  std::string GuessValue(const std::string& name) const;

  std::string module_name_;
  Output output_;
  ReadFile read_file_;
  AppendFile append_file_;
  OnError on_error_;
  Hook definition_hook_;
  ExitGate exit_gate_;
  OnHeard on_heard_;
  std::map<std::string, std::string, std::less<>> shortcuts_;
  std::vector<std::unique_ptr<Slot>> slots_;  // in order of declaration
  std::map<std::string, Slot*, std::less<>> by_name_;
  std::map<std::string, std::vector<std::pair<std::string, std::string>>, std::less<>> saved_;
  std::map<std::string, std::vector<std::string>, std::less<>> macros_;
  std::vector<std::string> reserved_;  // beginnings of names
  std::vector<PeerId> error_peers_;    // peers that asked for untagged error reports
  std::size_t user_slots_ = 0;
  std::size_t kept_bytes_ = 0;  // of user slots, macros and saved sets
  std::size_t depth_ = 0;       // `do` within `do`
  std::size_t lines_run_ = 0;   // by the outermost `do` under way
  std::shared_ptr<bool> alive_;
};

}  // namespace vm
