// Parts of a session: the wait for modules that are busy, and what of a log is said again.

#include <gtest/gtest.h>

#include <fstream>

#include "agent_manager/session/quiet_watch.h"
#include "agent_manager/session/replay.h"
#include "tests/agent_manager/world.h"
#include "tests/support/process.h"

namespace am {
namespace {

/// A peer that says it is a module with a clock, and is always busy.
std::shared_ptr<World::Peer> JoinBusy(World& world, Role role, const std::string& name) {
  auto peer = world.JoinAs(role, name);
  peer->on_line = [&world, weak = std::weak_ptr<World::Peer>(peer)](const std::string& line) {
    const auto self = weak.lock();
    const auto message = vm::ParseMessage(line);
    if (!self || !message || message->tag.empty()) return;
    const std::string value = message->slot == "Clock.busy" ? "BUSY" : "0";
    world.Say(*self, "rep#" + message->tag + " " + message->slot + " = " + value);
  };
  world.Say(*peer, "rep Run = LIVE");
  world.clock.RunReady();
  return peer;
}

TEST(QuietWatchTest, AGuestDoesNotKeepTheSessionFromItsEnd) {
  World world;
  QuietWatch quiet(world.clock, world.hub, [] { return false; });
  JoinBusy(world, Role::kGuest, "ROBOT");
  ASSERT_EQ(world.hub.clocks().WithClock().size(), 1u);
  quiet.Ask();
  world.clock.RunUntil(std::chrono::milliseconds(100));
  EXPECT_TRUE(quiet.quiet());
}

TEST(QuietWatchTest, AClientThatIsBusyDoes) {
  World world;
  QuietWatch quiet(world.clock, world.hub, [] { return false; });
  JoinBusy(world, Role::kClient, "ROBOT");
  quiet.Ask();
  world.clock.RunUntil(std::chrono::milliseconds(100));
  EXPECT_FALSE(quiet.quiet());
}

TEST(ReplayTest, SaysWhatPeopleAndClientsSaidAndNothingThatFollowedFromIt) {
  const support::TempDir folder;
  const std::string path = folder / "session.log";
  std::ofstream(path) << "# galatea session log 1: ms, sender, receivers, line\n"
                         "100\tCONSOLE\tFSM\tto @FSM set A = 1\n"
                         "100\tAM-MCL\tFSM\tto @FSM set A = 2\n"
                         "100\tSND\tFSM\tto @FSM set A = 3\n"
                         "100\tPAR\tFSM\tto @FSM set A = 4\n"
                         "100\tCONSOLE:do\tFSM\tto @FSM set A = 5\n"
                         "100\tSSM\tFSM\tto @FSM set A = 6\n"
                         "200\tROBOT\tFSM\tto @FSM set A = 7\n"
                         "300\tROBOT\t-\trep X = 1\n";
  World world;
  const auto face = world.Join(PeerKind::kModule, "FSM", Dialect::kOriginal);
  Replay replay(world.clock, world.hub, path, {"SSM"}, 1);
  EXPECT_EQ(replay.pending(), 2u);
  replay.Start([] {});
  world.clock.RunUntil(std::chrono::milliseconds(1000));
  EXPECT_EQ(face->heard, (std::vector<std::string>{"set A = 1", "set A = 7"}));
}

}  // namespace
}  // namespace am
