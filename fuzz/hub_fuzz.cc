// Several peers of every role talk to a hub in memory, with its own machines, macros and rights.
// Input: lines; the first byte of each says who says it, or that time passes, or that a peer goes.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "agent_manager/macros/macro_layer.h"
#include "agent_manager/macros/parallel.h"
#include "agent_manager/macros/sound_player.h"
#include "agent_manager/macros/speak.h"
#include "agent_manager/slots/built_in_dispatcher.h"
#include "tests/agent_manager/world.h"

namespace {

vm::Result<std::string> ReadFile(const std::string& path) {
  if (path == "script") return "to @SSM set Text = x\ndo script\nset A = 1\n";
  if (path == "macro") return "[{\"send\": \"to @AM-MCL do M\"}]";
  return vm::Fail(vm::Errc::kUnavailable, "no such file");
}

struct Session {
  Session()
      : am("AM"),
        macros(world.clock, world.hub, ReadFile, [](const std::string&) {}),
        parallel(world.clock, world.hub),
        sounds(world.hub),
        machines(world.hub, am, macros, built_in_machines, ReadFile) {
    world.hub.AddMachine(parallel.slots(), {}, true);
    world.hub.AddMachine(sounds.slots(), {}, true);
    world.hub.AddMachine(am);
    world.hub.AddMachine(macros.slots(), {"FS-MCL"});
    macros.AddReader("emotion", am::ReadEmotion);
    // Parsed once for all inputs, and only the macros with branches, waits and files: all of them
    // anew would be nine tenths of each input's time.
    static const auto built_in = am::ParseMacroFile(am::BuiltInMacros());
    for (const vm::SlotSpec& slot : built_in->slots) macros.Declare(slot);
    for (const am::Macro& macro : built_in->macros) {
      if (macro.name == "Speak" || macro.name == "Record" || macro.name == "Mask")
        static_cast<void>(macros.Define(macro));
    }
    am.Declare({.name = "Name",
                .grammar = "<word>",
                .access = vm::Access::kWriteOnly,
                .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                  const auto renamed = world.hub.Rename(value.peer, value.word(0));
                  if (!renamed) return std::unexpected(renamed.error());
                  return value.word(0);
                }});
    am.Declare({.name = "Subscribe",
                .grammar = "NONE | <word>...",
                .access = vm::Access::kWriteOnly,
                .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                  world.hub.Subscribe(value.peer, {value.word(0)});
                  return value.text;
                }});
    world.hub.router().set_on_report([this](const std::string& from, const vm::Message& message) {
      for (am::BuiltInMachine* machine : built_in_machines) machine->OnReport(from, message);
    });
    world.hub.set_on_presence(
        [this](const std::string& name, bool present, const std::string& reason) {
          for (am::BuiltInMachine* machine : built_in_machines)
            machine->OnPresence(name, present, reason);
        });
    peers = {world.Join(am::PeerKind::kConsole, "CONSOLE"),
             world.Join(am::PeerKind::kModule, "SSM"),
             world.Join(am::PeerKind::kModule, "FSM", am::Dialect::kOriginal),
             world.JoinAs(am::Role::kClient, "A"), world.JoinAs(am::Role::kGuest, "B")};
  }

  am::World world;
  vm::SlotMachine am;
  am::MacroLayer macros;
  am::Parallel parallel;
  am::SoundPlayer sounds;
  const std::array<am::BuiltInMachine*, 3> built_in_machines{&macros, &parallel, &sounds};
  am::BuiltInDispatcher machines;
  std::vector<std::shared_ptr<am::World::Peer>> peers;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kMaxLines = 64;
  std::string_view text(reinterpret_cast<const char*>(data), size);
  Session session;
  for (std::size_t lines = 0; !text.empty() && lines < kMaxLines; ++lines) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty()) continue;
    const std::size_t who = static_cast<unsigned char>(line.front()) % 8u;
    if (who < session.peers.size()) {
      session.world.Say(*session.peers[who], line.substr(1));
    } else if (who == 5) {
      session.world.clock.RunUntil(session.world.clock.Now() + std::chrono::milliseconds(2500));
    } else if (who == 6) {
      session.world.Leave(*session.peers[line.size() % session.peers.size()], "it goes");
    } else {
      session.world.hub.clocks().EndProbes(session.world.hub.clocks().Probing());
    }
  }
  session.world.clock.RunUntil(session.world.clock.Now() + std::chrono::minutes(3));
  return 0;
}
