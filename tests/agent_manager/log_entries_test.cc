#include <gtest/gtest.h>

#include <algorithm>

#include "agent_manager/log_tool/entries.h"

namespace am {
namespace {

using std::chrono::milliseconds;

constexpr const char* kLog =
    "# galatea session log 1\n"
    "1000\tA\tSSM\tto @SSM set#1 Text = hello\n"
    "1040\tSSM\t-\trep Text.pho = h[10]\n"
    "1050\tSSM\tA\tFrom @SSM rep#1 Text = hello\n"
    "1060\tA\tSSM\tto @SSM inq#2 Speaker\n"
    "1070\tSSM\tA\tFrom @SSM rep#2 Speaker.error = BUSY <not> now & \"then\"\n"
    "1080\tA\tFSM\tto @FSM set#1 Face = 1\n"
    "half a li\n"
    "1090\tAM\tA,B\tFrom @AM tell @FSM has gone\n";

class LogEntriesTest : public testing::Test {
 protected:
  std::size_t bad_ = 0;
  std::vector<Entry> entries_ = ParseLog(kLog, bad_);
  std::size_t Count(const Selection& selection) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        entries_, [&](const Entry& entry) { return Selects(selection, entry); }));
  }
};

TEST_F(LogEntriesTest, LinesAreTakenApartAndBadOnesCounted) {
  ASSERT_EQ(entries_.size(), 7u);
  EXPECT_EQ(bad_, 1u);
  EXPECT_EQ(entries_[0].message.slot, "Text");
  EXPECT_EQ(entries_[6].receivers, (std::vector<std::string>{"A", "B"}));
  EXPECT_TRUE(entries_[1].receivers.empty());
}

TEST_F(LogEntriesTest, SelectionsNarrowDown) {
  EXPECT_EQ(Count({}), 7u);
  EXPECT_EQ(Count({.from = {"SSM"}}), 3u);
  EXPECT_EQ(Count({.to = {"B", "FSM"}}), 2u);
  EXPECT_EQ(Count({.slot = {"Text*"}}), 3u);
  EXPECT_EQ(Count({.command = {"set", "inq"}}), 3u);
  EXPECT_EQ(Count({.text = "hello"}), 2u);
  EXPECT_EQ(Count({.since = milliseconds(1050), .until = milliseconds(1070)}), 3u);
}

TEST_F(LogEntriesTest, RequestsArePairedWithTheirAnswers) {
  const auto exchanges = FindExchanges(entries_);
  ASSERT_EQ(exchanges.size(), 3u);
  EXPECT_EQ(*exchanges[0].answered - exchanges[0].asked, milliseconds(50));
  EXPECT_FALSE(exchanges[0].refused);
  EXPECT_TRUE(exchanges[1].refused);
  EXPECT_FALSE(exchanges[2].answered) << "the same tag, but another module, which never answered";
  const std::string table = DelayTable(exchanges);
  EXPECT_NE(table.find("SSM             Text                               1          50"),
            std::string::npos)
      << table;
}

TEST_F(LogEntriesTest, TheTimelineShowsEveryPartyAndEscapesWhatTheySay) {
  const std::string svg = TimelineSvg(entries_, FindExchanges(entries_));
  for (const char* name : {">A<", ">B<", ">SSM<", ">FSM<", ">AM<"})
    EXPECT_NE(svg.find(name), std::string::npos) << name;
  EXPECT_EQ(svg.find("<not>"), std::string::npos);
  EXPECT_NE(svg.find("&lt;not&gt; now &amp; &quot;then&quot;"), std::string::npos);
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_TRUE(TimelineSvg({}, {}).ends_with("</svg>\n"));
}

}  // namespace
}  // namespace am
