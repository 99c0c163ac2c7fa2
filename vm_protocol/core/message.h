#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vm {

/// The eight commands of the original's table, and the two words a module starts its own
/// messages with.
enum class Command { kSet, kInq, kProp, kSave, kRest, kDel, kDef, kDo, kRep, kTell };

/// How the value relates to the slot: `=` is it, `<` comes from the file named, `<<` is appended.
enum class Relation { kNone, kAssign, kFromFile, kAppend };

std::string_view CommandName(Command command);
std::string_view RelationSign(Relation relation);  ///< "" for kNone

/// One line of the protocol, taken apart:
///
///     [to @NAME[,@NAME...]] [from @NAME] COMMAND[#TAG] SLOT[.PART...] [REL VALUE]
///     [to @NAME[,@NAME...]] [from @NAME] tell TEXT
///
/// A plain value: copy and compare freely. Valid (`IsValid`) messages survive
/// Parse(Format(m)) == m; see docs/protocol.md for the grammar.
struct Message {
  std::vector<std::string> to;  ///< receivers without '@'; empty = whoever the stream belongs to
  std::string from;             ///< sender without '@'; written by the hub only
  Command command = Command::kTell;
  std::string tag;   ///< request tag without '#', letters digits '-' '_'; empty = none
  std::string slot;  ///< dotted path, e.g. "Speak.stat"; empty for `tell`
  Relation relation = Relation::kNone;
  std::string value;  ///< the rest of the line; no leading blank, no CR or LF

  bool operator==(const Message&) const = default;
};

/// Reads one line (without its newline; a final CR is dropped). Pure.
/// A byte order mark before it, which some programs write at the start of a stream, is passed over.
/// Loose where the original was: `a=b`, tabs, any case of to/from, `to @A,B`, `inq SLOT anything`.
/// Errors: kEmpty (blank, or a comment: `#` or `//` first), kTooLong, kBadUtf8, kUnknownCommand,
/// kSyntax; the error has the column, what was found and what was expected.
Result<Message> ParseMessage(std::string_view line);

/// The request tag of a line that is no message, so that whoever asked hears why; empty: none can
/// be read.
std::string TagOf(std::string_view line);

/// Writes a message exactly as the original does: one blank between words, "SLOT = VALUE".
/// The `from` identifier is written "From @X", as its hub did. REQUIRES: IsValid(message).
std::string FormatMessage(const Message& message);

/// True if every field fits the grammar and the limits, so that the line can be read back.
bool IsValid(const Message& message);

/// True for a slot path: parts of letters, digits, '_' '-' or bytes of UTF-8 beyond ASCII,
/// joined by single dots, at most kMaxNameBytes.
bool IsSlotName(std::string_view name);
bool IsModuleName(std::string_view name);
bool IsTag(std::string_view tag);

// Short ways to make the common messages.
Message Set(std::string slot, std::string value);
Message Inq(std::string slot);
Message Rep(std::string slot, std::string value);
Message Tell(std::string text);
/// `message` addressed to one receiver.
Message To(std::string module, Message message);

}  // namespace vm
