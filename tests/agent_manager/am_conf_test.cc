#include "agent_manager/config/am_conf.h"

#include <gtest/gtest.h>

#include "agent_manager/macros/parallel.h"
#include "tests/agent_manager/world.h"

namespace am {
namespace {

using Strings = std::vector<std::string>;

TEST(AmConfTest, TheOriginalsConfigurationIsRead) {
  const std::string text =
      "# made by a runner\n\nbroadcast: AM-MCL FS-MCL PAR DM\n"
      "module:FSM\tcommands: cd fsm; ./fsm -C a.conf\r\n"
      "module:AM-MCL commands: ruby AM-MCL.rb -C am_mcl.conf\nmodule:DM    commands: ./dm\n";
  ASSERT_TRUE(IsAmConf(text));
  const auto config = ParseAmConf(text, "am.conf");
  ASSERT_TRUE(config) << config.error().text;
  EXPECT_EQ(config->broadcast, (Strings{"AM-MCL", "FS-MCL", "PAR", "DM"}));
  ASSERT_EQ(config->modules.size(), 2u);
  EXPECT_EQ(config->modules[0].name, "FSM");
  EXPECT_EQ(config->modules[0].command, (Strings{"/bin/sh", "-c", "cd fsm; ./fsm -C a.conf"}));
  EXPECT_EQ(config->notes, Strings{"am.conf line 5: @AM-MCL is a part of this hub, its program is "
                                   "not started"});
}

TEST(AmConfTest, JsonIsNotTakenForIt) {
  EXPECT_FALSE(IsAmConf("// a comment\n{\"modules\": []}"));
  EXPECT_FALSE(IsAmConf(""));
}

TEST(AmConfTest, FaultsNameTheLine) {
  for (const auto& [text, part] : std::vector<std::pair<const char*, const char*>>{
           {"broadcast: A\nnonsense", "line 2: found 'nonsense'"},
           {"module: commands: x", "found 'commands:', expected a module's name"},
           {"module:A", "expected module:NAME commands: LINE"},
           {"module:A commands:", "expected module:NAME commands: LINE"},
           {"module:A commands: x\nmodule:A commands: y", "line 2: found 'A'"}}) {
    const auto config = ParseAmConf(text, "am.conf");
    ASSERT_FALSE(config) << text;
    EXPECT_NE(config.error().text.find(part), std::string::npos) << config.error().text;
  }
}

TEST(ParallelTest, ItsLinesBeginWithTheSpeechAndKeepTheirTimes) {
  World world;
  Parallel parallel(world.clock, world.hub);
  world.hub.AddMachine(parallel.slots(), {}, true);
  world.hub.set_on_machine([&](vm::SlotMachine&, const Envelope& envelope) {
    parallel.Handle(envelope);
    return vm::Result<Router::Taken>(Router::Taken{.taken = true});
  });
  world.hub.set_on_report([&](const std::string& from, const vm::Message& message) {
    parallel.OnReport(from, message);
  });
  const auto voice = world.Join(PeerKind::kModule, "SSM", Dialect::kOriginal);
  const auto face = world.Join(PeerKind::kModule, "FSM", Dialect::kOriginal);
  const auto a = world.Join(PeerKind::kClient, "A");
  for (const char* line : {"to @PAR set Init = 1", "to @PAR set Cmd = to @FSM set FaceMot = NOD 1",
                           "to @PAR set Cmd = sleep 0.5", "to @PAR set Cmd = to @FSM set X = 2"})
    world.Say(*a, line);
  EXPECT_EQ(face->heard, Strings{});
  world.Say(*voice, "rep Speak.stat = SPEAKING");
  EXPECT_EQ(face->heard, Strings{"set FaceMot = NOD 1"});
  world.clock.RunUntil(std::chrono::milliseconds(499));
  EXPECT_EQ(face->heard.size(), 1u);
  world.clock.RunUntil(std::chrono::milliseconds(500));
  EXPECT_EQ(face->heard.back(), "set X = 2");
  world.Say(*a, "to @PAR set#1 Cmd = sleep long");
  EXPECT_NE(a->heard.back().find("rep#1 Cmd.error = BAD_VALUE"), std::string::npos);
  const auto own = world.Join(PeerKind::kModule, "PAR", Dialect::kOriginal);
  world.Say(*a, "to @PAR set Cmd = mine");
  EXPECT_EQ(own->heard, Strings{"set Cmd = mine"}) << "a module of that name takes its place";
}

}  // namespace
}  // namespace am
