#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "task_manager/grammar/compiler.h"
#include "task_manager/grammar/model.h"

namespace vxml::srgs {

/// Owns compiled grammars and links their references, fetching other grammars on the way (each URI
/// once, so grammars may refer to each other in circles).
/// Limits: kMaxGrammars fetched for one store, kMaxExpansions in all. Thread: one.
class GrammarStore {
 public:
  static constexpr std::size_t kMaxGrammars = 200;
  /// Gets the bytes of an absolute URI; the store has judged whether they may be read.
  using Fetch = std::function<vm::Result<std::string>(const std::string& uri)>;

  explicit GrammarStore(Fetch fetch);

  /// Links a grammar compiled by the caller and keeps it. Errors: as CompileBytes, kUnavailable
  /// (not fetched), kBadValue (no such rule, or a private one of another grammar).
  vm::Result<const Grammar*> Add(std::unique_ptr<Grammar> grammar);
  /// The grammar at `uri` (with #rule or without), linked; `rule`, if it is not null, gets the rule
  /// to start at, which must be there then.
  /// context.uri is who refers to it. Errors besides: kAccess (fetch::MayRead).
  vm::Result<const Grammar*> Load(const std::string& uri, const GrammarContext& context,
                                  const Rule** rule);

 private:
  vm::Result<Grammar*> Fetched(const std::string& uri, const GrammarContext& context);
  vm::Result<void> Link(Grammar& grammar);
  vm::Result<void> LinkExpansion(Grammar& grammar, Expansion& node);
  vm::Result<void> LinkReference(Grammar& grammar, Expansion& node);

  Fetch fetch_;
  std::map<std::string, std::unique_ptr<Grammar>> by_uri_;
  std::vector<std::unique_ptr<Grammar>> others_;
  std::size_t expansions_ = 0;
};

}  // namespace vxml::srgs
