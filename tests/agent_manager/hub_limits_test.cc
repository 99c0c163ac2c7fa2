#include <gtest/gtest.h>

#include "agent_manager/routing/hub.h"
#include "agent_manager/routing/limits.h"
#include "tests/agent_manager/world.h"

namespace am {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// A peer whose reading can be stopped, and who does not always read.
struct Reader {
  std::size_t backlog = 0;
  bool reads = true;
  bool paused = false;
  bool closed = false;
  std::size_t heard = 0;
};

class ReaderLink final : public Link {
 public:
  explicit ReaderLink(std::shared_ptr<Reader> reader) : reader_(std::move(reader)) {}
  void Send(const Outgoing& outgoing) override {
    ++reader_->heard;
    if (!reader_->reads) reader_->backlog += outgoing.line().size() + 1;
  }
  void Close() override { reader_->closed = true; }
  void PauseReading() override { reader_->paused = true; }
  void ResumeReading() override { reader_->paused = false; }
  std::size_t backlog_bytes() const override { return reader_->backlog; }

 private:
  std::shared_ptr<Reader> reader_;
};

class HubLimitsTest : public testing::Test {
 protected:
  std::pair<PeerKey, std::shared_ptr<Reader>> Join(const std::string& name,
                                                   PeerKind kind = PeerKind::kClient) {
    auto reader = std::make_shared<Reader>();
    const auto key = world_.hub.Attach(std::make_unique<ReaderLink>(reader), kind, Role::kOwner,
                                       name, Dialect::kOriginal);
    return {key.value_or(0), reader};
  }
  void Say(PeerKey peer, const std::string& line) {
    world_.hub.Receive(peer, std::string_view(line));
    world_.clock.Settle();
  }
  World world_;
  const std::string long_line_ = "to @SLOW set Text = " + std::string(60000, 'x');
};

TEST_F(HubLimitsTest, WhoSpeaksToAFullReaderIsHeldAndNobodyElse) {
  const auto [slow_key, slow] = Join("SLOW");
  const auto [loud_key, loud] = Join("LOUD");
  const auto [other_key, other] = Join("OTHER");
  slow->reads = false;
  int lines = 0;
  for (; !loud->paused && lines < 1000; ++lines) Say(loud_key, long_line_);
  EXPECT_GE(slow->backlog, world_.hub.limits().backlog_bytes / 2);
  EXPECT_LT(slow->backlog, world_.hub.limits().backlog_bytes);
  EXPECT_FALSE(slow->closed);
  Say(other_key, "to @LOUD set X = 1");
  EXPECT_FALSE(other->paused);
  EXPECT_EQ(loud->heard, 1u);
  slow->backlog = 0;
  world_.clock.RunUntil(world_.clock.Now() + milliseconds(20));
  EXPECT_FALSE(loud->paused) << "it goes on when the reader has read";
  EXPECT_EQ(slow->heard, static_cast<std::size_t>(lines)) << "and nothing is lost";
}

TEST_F(HubLimitsTest, AReaderThatTakesNothingIsCutOffAfterTheStatedTime) {
  const auto [slow_key, slow] = Join("SLOW");
  const auto [loud_key, loud] = Join("LOUD");
  slow->reads = false;
  while (!loud->paused) Say(loud_key, long_line_);
  world_.clock.RunUntil(world_.clock.Now() + milliseconds(4900));
  EXPECT_FALSE(slow->closed);
  world_.clock.RunUntil(world_.clock.Now() + milliseconds(200));
  EXPECT_TRUE(slow->closed);
  EXPECT_FALSE(world_.hub.directory().IsPresent("SLOW"));
  EXPECT_FALSE(loud->paused);
}

TEST_F(HubLimitsTest, ASlowHearerOfReportsIsCutOffAndDoesNotHoldTheModule) {
  const auto [slow_key, slow] = Join("SLOW");
  const auto [quick_key, quick] = Join("QUICK");
  const auto [module_key, module] = Join("SSM", PeerKind::kModule);
  slow->reads = false;
  world_.hub.Subscribe(slow_key, {"*"});
  world_.hub.Subscribe(quick_key, {"*"});
  const std::string report = "rep Text = " + std::string(60000, 'x');
  for (int i = 0; i < 100; ++i) {
    Say(module_key, report);
    world_.clock.RunReady();
    ASSERT_FALSE(module->paused);
  }
  EXPECT_TRUE(slow->closed);
  EXPECT_EQ(quick->heard, 100u);
}

TEST_F(HubLimitsTest, AFloodIsReadAtTheStatedRate) {
  world_.hub.set_limit(&Limits::messages_per_s, 100);
  const auto [key, reader] = Join("FLOOD");
  const auto [other_key, other] = Join("OTHER");
  int said = 0;
  for (int ms = 0; ms < 10000; ++ms) {
    for (int i = 0; i < 10 && !reader->paused; ++i, ++said) Say(key, "to @OTHER set X = 1");
    world_.clock.RunUntil(world_.clock.Now() + milliseconds(1));
  }
  // One second's worth at once, then 100 a second.
  EXPECT_NEAR(said, 100 + 1000, 5);
  EXPECT_EQ(other->heard, static_cast<std::size_t>(said));
  const auto status = world_.hub.Status();
  EXPECT_EQ(status[0].name, "FLOOD");
  EXPECT_EQ(status[0].traffic.messages_in, static_cast<std::uint64_t>(said));
  EXPECT_GT(status[0].traffic.throttled, 900u);
  EXPECT_EQ(status[1].traffic.throttled, 0u);
}

TEST_F(HubLimitsTest, APeerDefinesAtMostSoManySlots) {
  vm::SlotMachine machine("AM");
  world_.hub.AddMachine(machine);
  world_.hub.set_limit(&Limits::slots, 2);
  const auto a = world_.Join(PeerKind::kClient, "A");
  world_.Say(*a, "def#1 One = 1");
  world_.Say(*a, "def#2 Two = 2");
  world_.Say(*a, "def#3 Three = 3");
  EXPECT_EQ(a->heard.back(), "From @AM rep#3 Three.error = LIMIT @A has already defined 2 slots");
  world_.Say(*a, "del#4 One");
  world_.Say(*a, "def#5 Three = 3");
  EXPECT_EQ(a->heard.back(), "From @AM rep#5 Three = 3");
}

TEST(RateMeterTest, KeepsTheRateOverTimeWithOneSecondAtOnce) {
  RateMeter meter;
  vm::Time now(0);
  EXPECT_EQ(meter.Take(1000, 0, now), vm::Time(0)) << "no limit";
  for (int i = 0; i < 50; ++i) EXPECT_EQ(meter.Take(1, 50, now), vm::Time(0)) << i;
  EXPECT_NEAR(static_cast<double>(meter.Take(1, 50, now).count()), 20000, 1);
  now += seconds(2);
  EXPECT_EQ(meter.Take(1, 50, now), vm::Time(0));
}

}  // namespace
}  // namespace am
