// A whole module: a lamp that can be switched and fades out by itself.
// Try it:  printf 'set Lamp = ON 2000\nset Wait = IDLE\ninq Lamp\n' | build/bin/lamp_module

#include "vm_protocol/runtime/module_main.h"

class Lamp final : public vm::Module {
 public:
  explicit Lamp(vm::Scheduler& clock) : slots_("LAMP"), clock_(clock) {
    vm::DeclareCommonSlots(
        slots_,
        {.module_version = "1.0", .protocol_version = "1.0", .on_exit = [this] { exit_ = true; }});
    slots_.Declare(
        {.name = "Lamp",
         .grammar = "ON [ <ms> ] | OFF",
         .initial = "OFF",
         .auto_output = true,
         .help = "The light: ON, for so many ms or until OFF.",
         .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
           clock_.Cancel(timer_);
           timer_ = value.size() == 2
                        ? clock_.After(std::chrono::milliseconds(static_cast<int>(value.number(1))),
                                       [this] { Off(); })
                        : 0;
           return value.word(0);
         }});
  }
  vm::SlotMachine& slots() override { return slots_; }
  bool Busy() const override { return timer_ != 0; }
  bool ExitRequested() const override { return exit_; }

 private:
  void Off() {
    timer_ = 0;
    slots_.Report("Lamp", "OFF");
  }
  vm::SlotMachine slots_;
  vm::Scheduler& clock_;
  vm::TimerId timer_ = 0;
  bool exit_ = false;
};

int main(int argc, char** argv) {
  return vm::RunModule(
      argc, argv,
      {.name = "lamp_module",
       .description = "A lamp with a slot",
       .module_name = "LAMP",
       .virtual_by_default = true,
       .make = [](vm::Scheduler& clock, auto&) { return std::make_unique<Lamp>(clock); }});
}
