#pragma once

#include "task_manager/grammar/matcher.h"
#include "task_manager/script/engine.h"

namespace vxml::srgs {

/// Semantic interpretation (SISR 1.0): runs the tags of a parse and gives the root rule's value.
///   semantics/1.0            tags are ECMAScript with out, rules, meta
///   semantics/1.0-literals   a tag is the value itself
///   anything else            literals, unless the tag assigns to out, $ or $name
/// Without tags a rule has the value of its last referenced rule, or else the words it matched, as
/// the grammar writes them; the words of the whole input are `spoken`, as they were recognised.
/// Errors: kBadValue, kLimit from the scripts.
vm::Result<script::Value> Interpret(script::Engine& engine, const Parse& parse,
                                    const std::string& spoken);

}  // namespace vxml::srgs
