#include "agent_manager/config/am_conf.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace am
