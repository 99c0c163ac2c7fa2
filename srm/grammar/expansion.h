#pragma once

#include <string>
#include <string_view>

#include "srm/grammar/grammar.h"

/// What the two forms of grammar written as text share. They differ in how rules are named and in
/// what * means. Private to srm/grammar.
namespace srm {

enum class Form { kOwn, kJsgf };

/// What stands right of a rule's name. Errors: kSyntax with the line, kLimit.
vm::Result<Node> ParseExpansion(std::string_view text, Form form, std::size_t line);

bool IsBlank(char c);
bool IsNameByte(char c);
std::string_view Trim(std::string_view text);
std::unexpected<vm::Error> Wrong(std::size_t line, const std::string& what);

}  // namespace srm
