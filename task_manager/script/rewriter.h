#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vxml::script {

/// A script made ready to run inside `with` blocks of our scope objects, under a budget.
///   - every loop test, function entry and block that catches calls __t(), which counts and may
///     throw; for-in counts the names it goes over (__f), with keeps these names its own (__w);
///   - `var` at the top level loses its keyword, its names are listed: they become properties of
///     the scope, so functions of the script and later expressions share them;
///   - named functions at the top level become assignments, placed first (hoisting).
struct Rewritten {
  std::string code;
  std::vector<std::string> declared;
};

enum class SourceKind { kExpression, kScript };

/// Works on tokens, not on a full parse: what is not ECMAScript stays so and is refused later by
/// the engine. Errors: kSyntax for unbalanced brackets, unterminated strings or comments, names
/// with escapes or of ours, and a '/' of which tokens cannot tell whether it divides (after '}').
vm::Result<Rewritten> Rewrite(std::string_view source, SourceKind kind);

/// A bare name: letters, digits, '_' and '$', not starting with a digit (bytes beyond ASCII count
/// as letters), and not a reserved word.
bool IsIdentifier(std::string_view text);

struct Token {
  enum class Type { kWord, kNumber, kString, kRegex, kSign };
  Type type;
  std::string_view text;
  std::string_view before;  ///< blanks and comments in front of it
  bool newline_before = false;
};
vm::Result<std::vector<Token>> Tokenize(std::string_view source);

}  // namespace vxml::script
