#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "task_manager/grammar/compiler.h"

namespace vxml::srgs {

inline constexpr std::string_view kSrgsSpace = "http://www.w3.org/2001/06/grammar";

/// Compiles what stands inside the rules of a grammar in the XML form: tokens, references,
/// sequences, alternatives, repeats and tags (SRGS 1.0 section 2).
/// Lifetime: the context outlives it. Errors "URI:LINE:COLUMN: ..." with kSyntax, kLimit.
class XmlRules {
 public:
  using Made = vm::Result<std::unique_ptr<Expansion>>;

  /// `space`: the namespace of the <grammar> at hand, which may have none.
  XmlRules(const GrammarContext& context, std::string space)
      : context_(context), space_(std::move(space)) {}

  std::unexpected<vm::Error> Bad(const vm::xml::Node& at, const std::string& what,
                                 vm::Errc code = vm::Errc::kSyntax) const;
  /// Elements of other namespaces may stand anywhere and say nothing here (SRGS 1.0 appendix F).
  bool IsForeign(const vm::xml::Node& node) const;
  /// For elements whose content is nothing but text, or nothing at all.
  vm::Result<void> CheckContent(const vm::xml::Node& node, bool text) const;
  /// Text: tokens between blanks; "several words" in quotes are one token. False: a quotation mark
  /// has no partner.
  bool AddTokens(std::string_view text, Expansion& into) const;
  /// All children of `node`, one after the other.
  Made Sequence(const vm::xml::Node& node, std::size_t depth) const;
  Made Expand(const vm::xml::Node& node, std::size_t depth) const;

 private:
  Made Token(const vm::xml::Node& node) const;
  Made Reference(const vm::xml::Node& node) const;
  Made Item(const vm::xml::Node& node, std::size_t depth) const;
  Made OneOf(const vm::xml::Node& node, std::size_t depth) const;

  const GrammarContext& context_;
  std::string space_;
};

}  // namespace vxml::srgs
