#pragma once

#include <string>
#include <string_view>

#include "ear/grammar/grammar.h"

/// What the forms of grammar share, above all the two written as text. Those differ in how rules
/// are named and in what * means. Private to ear/grammar.
namespace ear {

enum class Form { kOwn, kJsgf };

/// What stands right of a rule's name; `parts` counts those of all rules so far. Errors: kSyntax,
/// kLimit, with the line.
vm::Result<Node> ParseExpansion(std::string_view text, Form form, std::string_view rule,
                                std::size_t line, std::size_t& parts);

/// GARBAGE of SRGS: any words or none.
Node GarbageNode(std::size_t line);
/// "line 3: "; nothing if it is not known (0).
std::string AtLine(std::size_t line);
std::string NestedTooDeep();
std::string TooManyParts();
bool IsBlank(char c);
bool IsNameByte(char c);
std::string_view Trim(std::string_view text);
std::unexpected<vm::Error> Wrong(std::size_t line, const std::string& what);

}  // namespace ear
