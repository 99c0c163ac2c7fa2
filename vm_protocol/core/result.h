#pragma once

#include <cstddef>
#include <expected>
#include <string>
#include <string_view>

namespace vm {

/// What kind of thing went wrong. Closed: a caller may switch over it. The wire spelling
/// (`ErrcName`) is part of the protocol, see docs/protocol.md "Errors".
enum class Errc {
  kEmpty,           ///< blank line or comment: nothing to do, not a fault
  kSyntax,          ///< the line is not a message
  kTooLong,         ///< over a stated limit of size
  kBadUtf8,         ///< not UTF-8
  kUnknownCommand,  ///< the word is none of the protocol's commands
  kUnknownSlot,     ///< this module has no such slot
  kAccess,          ///< the slot cannot be set (or read, or deleted)
  kBadValue,        ///< the value does not match the slot's grammar
  kBusy,            ///< refused in the present state; try again after the state named in the text
  kUnknownModule,   ///< the hub knows no module of that name
  kUnavailable,     ///< something needed from outside is missing (device, file, engine, peer)
  kTimeout,         ///< a wait ran out
  kStopped,         ///< ended on request before it was complete
  kLimit,           ///< a stated limit of count was reached
  kInternal,        ///< our own fault
};

/// "SYNTAX", "UNKNOWN_SLOT", ...: the word used on the wire.
std::string_view ErrcName(Errc code);

/// A failure a caller must handle. `text` names the input, the place and what was expected.
struct Error {
  Errc code = Errc::kInternal;
  std::string text;
  std::size_t column = 0;  ///< 1-based byte column in the offending line; 0 = no place

  bool operator==(const Error&) const = default;
};

template <typename T>
using Result = std::expected<T, Error>;

inline std::unexpected<Error> Fail(Errc code, std::string text, std::size_t column = 0) {
  return std::unexpected<Error>(Error{code, std::move(text), column});
}

/// "CODE text" (with "column N: " before the text when there is a place), as sent on the wire.
std::string FormatError(const Error& error);

}  // namespace vm
