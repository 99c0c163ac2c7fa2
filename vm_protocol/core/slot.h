#pragma once

#include <string>

#include "vm_protocol/core/slot_machine.h"
#include "vm_protocol/core/value_grammar.h"

namespace vm {

/// A declared slot with its present value. Private to the slot machine's own sources.
struct SlotMachine::Slot {
  explicit Slot(SlotSpec declared)
      : spec(std::move(declared)),
        grammar(spec.grammar),
        value(spec.initial),
        auto_output(spec.auto_output) {}

  std::string Help() const;        ///< the answer to `inq NAME.help`
  std::string Attributes() const;  ///< the answer to `inq NAME.prop`

  SlotSpec spec;
  ValueGrammar grammar;
  std::string value;
  bool auto_output;
  bool user_made = false;
};

}  // namespace vm
