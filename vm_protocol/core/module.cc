#include "vm_protocol/core/module.h"

namespace vm {

namespace {

std::string RunHelp(const CommonSlots& common) {
  constexpr auto kSleep = " SLEEP, which scripts of the original have, does nothing.";
  if (common.on_start) {
    return "START: " + common.work + " from now on. STOP: no longer. EXIT ends the module." +
           kSleep;
  }
  return std::string("LIVE while the module runs. EXIT ends it") +
         (common.on_init ? ", INIT resets everything to its state at start." : ".") + kSleep;
}

void SetRun(SlotMachine& slots, const CommonSlots& common, const std::string& word,
            const Reply& reply) {
  if (word == "SLEEP") return reply.Ok("LIVE");
  if (word == "INIT") {
    common.on_init();
    return reply.Ok("LIVE");
  }
  if (word == "START") {
    if (auto started = common.on_start(); !started) return reply.Fail(started.error());
  }
  if (word != "EXIT" || common.report_exit) slots.Report("Run", word);
  if (word == "STOP" && common.on_stop) common.on_stop();
  reply.Ok(word);
  if (word == "EXIT" && common.on_exit) common.on_exit();
}

}  // namespace

void DeclareCommonSlots(SlotMachine& slots, const CommonSlots& common) {
  slots.Declare({.name = "Run",
                 .grammar = std::string(common.on_start ? "START | STOP | " : "") + "LIVE | " +
                            (common.on_init ? "INIT | " : "") + "SLEEP | EXIT",
                 .initial = "LIVE",
                 .auto_output = common.auto_output,
                 .help = RunHelp(common),
                 .on_set_later =
                     [&slots, common](const SetValue& value, const Reply& reply) {
                       SetRun(slots, common, value.word(0), reply);
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
