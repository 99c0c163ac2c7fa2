// A module with one number and one thing that takes time, for tests of the runtime.

#include <chrono>

#include "vm_protocol/runtime/module_main.h"

namespace {

class TestModule final : public vm::Module {
 public:
  explicit TestModule(vm::Scheduler& clock) : slots_("TEST"), clock_(clock) {
    vm::DeclareCommonSlots(slots_, {.module_version = "1",
                                    .protocol_version = "2",
                                    .auto_output = true,
                                    .on_exit = [this] { exit_ = true; }});
    slots_.Declare({.name = "X", .grammar = "<number>", .initial = "0", .auto_output = true});
    // When this process's clock stood at 0, in ms of the machine's: for tests of clock offsets.
    slots_.Declare(
        {.name = "Epoch", .grammar = "<number>", .access = vm::Access::kReadOnly, .on_inq = [this] {
           const auto now = std::chrono::system_clock::now().time_since_epoch();
           return vm::FormatMs(std::chrono::duration_cast<vm::Time>(now) - clock_.Now());
         }});
    slots_.Declare({.name = "Work",
                    .grammar = "<ms>",
                    .access = vm::Access::kWriteOnly,
                    .on_set_later = [this](const vm::SetValue& value, const vm::Reply& reply) {
                      ++working_;
                      clock_.After(vm::Time(static_cast<vm::Time::rep>(value.number(0) * 1000)),
                                   [this, reply] {
                                     --working_;
                                     slots_.TellAll("worked until " + vm::FormatMs(clock_.Now()));
                                     reply.Ok("done");
                                   });
                    }});
    // Work whose end no timer tells.
    slots_.Declare({.name = "Settle",
                    .grammar = "<ms>",
                    .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                      settled_ = clock_.Now() +
                                 vm::Time(static_cast<vm::Time::rep>(value.number(0) * 1000));
                      return value.text;
                    }});
  }
  vm::SlotMachine& slots() override { return slots_; }
  bool Busy() const override { return working_ > 0 || clock_.Now() < settled_; }
  bool ExitRequested() const override { return exit_; }

 private:
  vm::SlotMachine slots_;
  vm::Scheduler& clock_;
  int working_ = 0;
  vm::Time settled_{0};
  bool exit_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  return vm::RunModule(
      argc, argv,
      {.name = "test_module",
       .description = "A module for tests",
       .module_name = "TEST",
       .original_port = 10600,
       .virtual_by_default = true,
       .make = [](vm::Scheduler& clock, auto&) { return std::make_unique<TestModule>(clock); }});
}
