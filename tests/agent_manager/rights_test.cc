#include "agent_manager/access/rights.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "agent_manager/config/config.h"
#include "agent_manager/macros/line_scripts.h"
#include "agent_manager/macros/macro_layer.h"
#include "agent_manager/slots/built_in_dispatcher.h"
#include "tests/agent_manager/world.h"
#include "tests/support/process.h"

namespace am {
namespace {

using Strings = std::vector<std::string>;

TEST(LiesWithinTest, ComparesNamesAndNotBeginnings) {
  const support::TempDir root;
  std::filesystem::create_directories(root / "d/in");
  std::filesystem::create_directories(root / "d2");
  const std::string d = root / "d";
  EXPECT_TRUE(LiesWithin(d + "/x.wav", "", {d}));
  EXPECT_TRUE(LiesWithin("x.wav", d, {d}));
  EXPECT_TRUE(LiesWithin(d + "/in/../x.wav", "", {d + "/"}));
  EXPECT_FALSE(LiesWithin(root / "d2/x.wav", "", {d}));
  EXPECT_FALSE(LiesWithin(d + "/../x.wav", "", {d}));
  EXPECT_FALSE(LiesWithin("../x.wav", d, {d}));
  EXPECT_FALSE(LiesWithin(d + "/x.wav", "", {}));
  EXPECT_FALSE(LiesWithin(d + "/x.wav", "", {""}));
  EXPECT_TRUE(LiesWithin("/etc/passwd", "", {"/"}));
}

TEST(LiesWithinTest, FollowsLinksAndRefusesWhatIsNoPath) {
  const support::TempDir root;
  std::filesystem::create_directories(root / "d");
  std::filesystem::create_symlink("/etc", root / "d/link");
  const std::string d = root / "d";
  EXPECT_FALSE(LiesWithin(d + "/link/passwd", "", {d}));
  EXPECT_FALSE(LiesWithin("unix:" + d + "/sound", d, {d}));
  EXPECT_FALSE(LiesWithin("tcp:7000", d, {d}));
  EXPECT_FALSE(LiesWithin("-", d, {d}));
}

/// A hub with its own machines, a module that tells which of its slots take files, and peers of
/// every role.
class RightsTest : public testing::Test {
 protected:
  RightsTest()
      : am_("AM"),
        macros_(world_.clock, world_.hub, Read,
                [this](const std::string& path) { removed_.push_back(path); }),
        machines_(world_.hub, am_, macros_, built_in_machines_, Read) {
    world_.hub.AddMachine(am_);
    world_.hub.AddMachine(macros_.slots(), {"FS-MCL"});
    world_.hub.router().set_on_report([this](const std::string& from, const vm::Message& message) {
      macros_.OnReport(from, message);
    });
    module_ = world_.JoinModern("SSM", vm::Time(0), [this](World::Peer&, const vm::Message& said) {
      if (said.command == vm::Command::kSet) set_.push_back(said.slot + " = " + said.value);
    });
    for (const Role role : kRoles)
      peers_[role] = world_.JoinAs(role, "P" + std::string(RoleName(role)));
    set_.clear();
  }
  static vm::Result<std::string> Read(const std::string& path) { return "def U = " + path; }
  /// The answer to a tagged line of a peer of that role.
  std::string Say(Role role, const std::string& line) {
    World::Peer& peer = *peers_[role];
    peer.heard.clear();
    world_.Say(peer, line);
    world_.clock.RunUntil(world_.clock.Now() + std::chrono::seconds(3));
    return peer.heard.empty() ? "" : peer.heard.back();
  }
  static bool Refused(const std::string& answer) {
    return answer.find(".error = ACCESS") != std::string::npos;
  }

  World world_;
  vm::SlotMachine am_;
  MacroLayer macros_;
  const std::array<BuiltInMachine*, 1> built_in_machines_{&macros_};
  BuiltInDispatcher machines_;
  std::shared_ptr<World::Peer> module_;
  std::map<Role, std::shared_ptr<World::Peer>> peers_;
  Strings set_, removed_;
};

TEST_F(RightsTest, AGuestNamesNoFileInWhateverWay) {
  for (const char* line :
       {"to @SSM set#1 SaveWAV = /tmp/x.wav",
        "to @SSM set#1 Text = <speak>a<audio src=\"/tmp/x.wav\"/></speak>",
        "to @SSM set#1 Text < /etc/passwd", "to @SSM set#1 Record = x.wav",
        "to @SSM set#1 Record << STOP", "to @SSM set#1 Input = unix:/tmp/s", "do#1 /etc/passwd",
        "to @SSM do#1 some.file", "to @AM-MCL do#1 ./x", "set#1 U < /etc/hostname",
        "to @SSM save#1 s << /tmp/x", "to @AM,@FS-MCL def#1 M < /etc/passwd"})
    EXPECT_TRUE(Refused(Say(Role::kGuest, line))) << line << ": " << Say(Role::kGuest, line);
  EXPECT_EQ(set_, Strings{});
  EXPECT_EQ(Say(Role::kGuest, "to @SSM set#1 Record = STOP"), "From @SSM rep#1 Record = STOP");
  EXPECT_EQ(Say(Role::kGuest, "to @SSM set#1 Text = hello"), "From @SSM rep#1 Text = hello");
}

TEST_F(RightsTest, NobodyMutesWhatAllHear) {
  for (const char* line :
       {"prop#1 Refused = NoAutoOutput", "to @SSM prop#1 Speak.stat = NoAutoOutput",
        "to @AM-MCL prop#1 Speak = NoAutoOutput"}) {
    EXPECT_TRUE(Refused(Say(Role::kGuest, line))) << line;
    EXPECT_TRUE(Refused(Say(Role::kClient, line))) << line;
  }
}

TEST_F(RightsTest, ARefusalNamesTheRule) {
  EXPECT_EQ(Say(Role::kGuest, "to @SSM set#1 SaveWAV = x.wav"),
            "From @AM rep#1 SaveWAV.error = ACCESS a guest may not name the file 'x.wav' "
            "(rights.guest.files)");
  EXPECT_EQ(Say(Role::kClient, "set#1 Stop = SSM"),
            "From @AM rep#1 Stop.error = ACCESS a client may not start and stop modules "
            "(rights.client.may: stop)");
}

TEST_F(RightsTest, AClientNamesFilesBelowItsFoldersAndTheOwnerAll) {
  const support::TempDir folder;
  RightsTable table = RightsTable::Default();
  table[Role::kClient].files = {folder.path()};
  world_.hub.set_rights(table);
  EXPECT_FALSE(Refused(Say(Role::kClient, "to @SSM set#1 SaveWAV = " + (folder / "x.wav"))));
  EXPECT_TRUE(Refused(Say(Role::kClient, "to @SSM set#1 SaveWAV = " + (folder / "../x.wav"))));
  EXPECT_TRUE(Refused(Say(Role::kClient, "to @SSM set#1 SaveWAV = " + folder.path() + "2/x.wav")));
  EXPECT_FALSE(Refused(Say(Role::kOwner, "to @SSM set#1 SaveWAV = /anywhere/x.wav")));
}

TEST_F(RightsTest, OnlyTheOwnerDefinesStopsReloadsAndWatches) {
  for (const char* line :
       {"to @AM-MCL def#1 M = []", "to @AM-MCL def#1 M << to @SSM set X = 1",
        "to @FS-MCL def#1 M = {\"steps\": []}", "def#1 M << set X = 1", "set#1 Stop = SSM",
        "set#1 Run = EXIT", "set#1 Run = exit", "set#1 Run << EXIT", "to @SSM set#1 Run = EXIT",
        "set#1 Reload = NOW", "set#1 Flow = ON", "set#1 Limit.peers = 1", "rest#1 S",
        "to @SSM set#1 Wait = 3600000", "to @SSM set#1 Clock.mode = HUB",
        "to @SSM set#1 Clock = 1"}) {
    EXPECT_TRUE(Refused(Say(Role::kGuest, line))) << line;
    EXPECT_TRUE(Refused(Say(Role::kClient, line))) << line;
  }
  EXPECT_EQ(Say(Role::kOwner, "to @AM-MCL def#1 M = []"), "From @AM-MCL rep#1 M = defined");
}

TEST_F(RightsTest, LinesThatAModuleKeepsAreCheckedWhenTheyAreGivenToIt) {
  const auto client = [this](const std::string& line) { return Say(Role::kClient, line); };
  for (const char* line :
       {"set SaveWAV = /tmp/x.wav", "set Text < /etc/passwd", "set Run = EXIT", "set Wait = 5",
        "def n << set Run = EXIT", "def n << set SaveWAV = /tmp/x.wav", "do some.file"})
    EXPECT_TRUE(Refused(client(std::string("to @SSM def#1 m << ") + line))) << line;
  EXPECT_TRUE(Refused(client("to @SSM def#1 m < ./lines"))) << "nobody knows what is in it";
  EXPECT_FALSE(Refused(client("to @SSM def#1 m << set Text = hello")));
  EXPECT_TRUE(Refused(client("to @SSM do#1 m"))) << "it may as well be a file";
  std::string nested = "to @SSM def#1 m << ";
  for (int i = 0; i < 9000; ++i) nested += "def m<<";
  EXPECT_TRUE(Refused(client(nested + "set V = 1")));
  EXPECT_TRUE(Refused(client("to @SSM set#1 Text < ./t.ssml"))) << "it may name any file";
  EXPECT_FALSE(Refused(Say(Role::kOwner, "to @SSM do#1 any.file")));
}

TEST_F(RightsTest, AClientsOwnNewFilesAreItsAndNobodyStopsReportsForAll) {
  EXPECT_FALSE(Refused(Say(Role::kClient, "to @SSM set#1 SaveWAV = x-that-is-not-there.wav")));
  for (const Role role : {Role::kClient, Role::kGuest}) {
    EXPECT_TRUE(Refused(Say(role, "to @SSM prop#1 Speak.stat = NoAutoOutput")));
    EXPECT_TRUE(Refused(Say(role, "to @SSM prop#1 Error = NoAutoOutput")));
    EXPECT_FALSE(Refused(Say(role, "to @SSM prop#1 Speak.stat = AutoOutput")));
  }
}

TEST_F(RightsTest, AMacroHasTheRightsOfWhoStartsIt) {
  Say(Role::kOwner,
      R"(to @AM-MCL def Keep = [{"request": "to @SSM set SaveWAV = ${value}"}, {"remove": "${value}"}])");
  const std::string answer = Say(Role::kGuest, "to @AM-MCL set#1 Keep = /tmp/x.wav");
  EXPECT_NE(answer.find("Keep.error"), std::string::npos) << answer;
  EXPECT_EQ(set_, Strings{});
  EXPECT_EQ(removed_, Strings{});
  EXPECT_EQ(Say(Role::kOwner, "to @AM-MCL set#1 Keep = /tmp/x.wav"),
            "From @AM-MCL rep#1 Keep = /tmp/x.wav");
  EXPECT_EQ(removed_, Strings{"/tmp/x.wav"});
}

TEST_F(RightsTest, AMacroThatSaysSoHasTheRightsOfWhoDefinedIt) {
  Say(Role::kOwner,
      R"(to @AM-MCL def Keep = {"rights": "definer", "steps": [{"request": "to @SSM set SaveWAV = /kept.wav"}]})");
  EXPECT_EQ(Say(Role::kGuest, "to @AM-MCL set#1 Keep = x"), "From @AM-MCL rep#1 Keep = x");
  EXPECT_EQ(set_, Strings{"SaveWAV = /kept.wav"});
}

TEST_F(RightsTest, AMacroOfAClientWhoMayDefineRemovesNothing) {
  RightsTable table = RightsTable::Default();
  table[Role::kClient].may = {Permission::kDefine};
  world_.hub.set_rights(table);
  Say(Role::kClient, R"(to @AM-MCL def#1 Gone = [{"remove": "${value}"}])");
  const std::string answer = Say(Role::kOwner, "to @AM-MCL set#1 Gone = file");
  EXPECT_NE(answer.find("a client may not remove files (rights.client.may: remove)"),
            std::string::npos)
      << answer;
  EXPECT_EQ(removed_, Strings{});
}

TEST_F(RightsTest, AModuleThatTellsOfItsFileSlotsIsProtectedToo) {
  const auto odd = std::make_shared<World::Peer>();
  odd->on_line = [this, &peer = *odd](const std::string& line) {
    const auto said = vm::ParseMessage(line);
    if (!said || said->tag.empty()) return;
    const std::string value = said->slot == "Clock" ? "5"
                              : said->slot == "Slots.files"
                                  ? "Odd.name <word> <file>; Bad <nonsense"
                                  : said->value;
    world_.Say(peer, "rep#" + said->tag + " " + said->slot + " = " + value);
  };
  const auto joined = world_.Join(PeerKind::kModule, "ODD", Dialect::kAuto, odd->on_line);
  odd->key = joined->key;
  world_.clock.RunReady();
  EXPECT_TRUE(Refused(Say(Role::kGuest, "to @ODD set#1 Odd.name = a /etc/passwd")));
  EXPECT_TRUE(Refused(Say(Role::kGuest, "to @ODD set#1 Bad = anything")));
  EXPECT_EQ(Say(Role::kGuest, "to @ODD set#1 Other = anything"),
            "From @ODD rep#1 Other = anything");
}

TEST_F(RightsTest, NamesAreThoseThatTheRoleMayHaveAndThatShow) {
  RightsTable table = RightsTable::Default();
  table[Role::kGuest].names = {"VISITOR*"};
  world_.hub.set_rights(table);
  const PeerKey guest = peers_[Role::kGuest]->key;
  EXPECT_FALSE(world_.hub.Rename(guest, "FSM"));
  EXPECT_TRUE(world_.hub.Rename(guest, "VISITOR1"));
  const PeerKey client = peers_[Role::kClient]->key;
  for (const char* name : {"CONSOLE", "AM", "MQTT", "A\u202eB", "A\u200bB", "SSM"})
    EXPECT_FALSE(world_.hub.Rename(client, name)) << name;
  EXPECT_TRUE(world_.hub.Rename(client, "花子"));
  for (const char* name : {"A\u3164", "\uFFA0", "B\u2800"})
    EXPECT_FALSE(world_.hub.Rename(client, name)) << "it is seen as nothing";
}

TEST_F(RightsTest, TheLinesOfDoGoThroughTheHubAsWhoeverDoesIt) {
  Say(Role::kOwner, "def#1 Both << to @SSM set Text = one");
  Say(Role::kOwner, "def#1 Both << to @SSM set SaveWAV = /x.wav");
  set_.clear();
  EXPECT_EQ(Say(Role::kOwner, "do#1 Both"), "From @AM rep#1 Both = 2 lines");
  EXPECT_EQ(set_, (Strings{"Text = one", "SaveWAV = /x.wav"}));
  set_.clear();
  Say(Role::kGuest, "do#1 Both");
  EXPECT_EQ(set_, Strings{"Text = one"}) << "its second line names a file";
}

TEST_F(RightsTest, AScriptThatDoesItselfEnds) {
  Say(Role::kOwner, "def Twice << do Twice");
  Say(Role::kOwner, "def Twice << do Twice");
  world_.hub.set_on_notice(nullptr);
  Say(Role::kOwner, "do#1 Twice");
  const auto& heard = peers_[Role::kOwner]->heard;
  EXPECT_EQ(heard.front(), "From @AM rep#1 Twice = 2 lines");
  EXPECT_NE(heard.back().find("LIMIT"), std::string::npos) << heard.back();
  EXPECT_TRUE(world_.hub.idle());
}

TEST(RightsConfigTest, RowsChangeTheDefaultOnesMemberByMember) {
  const auto config = ParseConfig(
      R"({"rights": {"guest": {"files": ["/srv/a"], "may": ["define", "stop"]}},
          "listen": [{"at": "unix:/tmp/x", "role": "owner"}, "tcp:127.0.0.1:0"],
          "web": {"at": "tcp:127.0.0.1:0", "role": "client"}})",
      "am.json", ".");
  ASSERT_TRUE(config) << config.error().text;
  const Rights& guest = config->rights[Role::kGuest];
  EXPECT_EQ(guest.files, Strings{"/srv/a"});
  EXPECT_TRUE(guest.May(Permission::kStop));
  EXPECT_FALSE(guest.May(Permission::kRemove));
  EXPECT_EQ(guest.commands, RightsTable::Default()[Role::kGuest].commands);
  EXPECT_EQ(config->listen[0].role, Role::kOwner);
  EXPECT_FALSE(config->listen[1].role);
  EXPECT_EQ(config->web.role, Role::kClient);
}

TEST(RightsConfigTest, FaultsNameTheRow) {
  for (const auto& [text, part] : std::vector<std::pair<const char*, const char*>>{
           {R"({"king": {}})", "rights.king: unknown key"},
           {R"({"owner": {}})", "rights.owner: unknown key"},
           {R"({"guest": {"may": ["fly"]}})", "rights.guest.may[0]: found \"fly\""},
           {R"({"guest": {"files": "x"}})", "rights.guest.files: found \"x\""},
           {R"({"guest": {"files": ["/srv", ""]}})",
            "rights.guest.files[1]: found \"\", expected a folder, or \"/\" for all files"}}) {
    const auto config = ParseConfig(std::string("{\"rights\": ") + text + "}", "am.json", ".");
    ASSERT_FALSE(config) << text;
    EXPECT_NE(config.error().text.find(part), std::string::npos) << config.error().text;
  }
}

}  // namespace
}  // namespace am
