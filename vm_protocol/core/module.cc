#include "vm_protocol/core/module.h"

namespace vm {

void DeclareCommonSlots(SlotMachine& slots, const CommonSlots& common) {
  slots.Declare({.name = "Run",
                 .grammar = common.on_init ? "LIVE | INIT | SLEEP | EXIT" : "LIVE | SLEEP | EXIT",
                 .initial = "LIVE",
                 .auto_output = common.auto_output,
                 .help = std::string("LIVE while the module runs. EXIT ends it") +
                         (common.on_init ? ", INIT resets everything to its state at start" : "") +
                         ". SLEEP, which scripts of the original have, does nothing.",
                 .on_set_later =
                     [&slots, common](const SetValue& value, const Reply& reply) {
                       if (value.word(0) == "INIT") {
                         common.on_init();
                         return reply.Ok("LIVE");
                       }
                       if (value.word(0) == "EXIT") {
                         if (common.report_exit) slots.Report("Run", "EXIT");
                         reply.Ok("EXIT");
                         if (common.on_exit) common.on_exit();
                         return;
                       }
                       if (value.word(0) != "SLEEP") slots.Report("Run", "LIVE");
                       reply.Ok("LIVE");
                     },
                 .saved = false});
  slots.Declare({.name = "ModuleVersion",
                 .grammar = "<text>",
                 .access = Access::kReadOnly,
                 .initial = common.module_version,
                 .help = "The version of this program.",
                 .quoted = common.quoted_versions});
  slots.Declare({.name = "ProtocolVersion",
                 .grammar = "<text>",
                 .access = Access::kReadOnly,
                 .initial = common.protocol_version,
                 .help = "The version of the protocol it speaks.",
                 .quoted = common.quoted_versions});
}

}  // namespace vm
