// Hubs joined by a real broker.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>

#include "tests/support/certificates.h"
#include "tests/support/mosquitto.h"
#include "tests/support/process.h"

namespace {

using support::Mosquitto;
using support::Process;

const std::string kHub = GALATEA_BIN_DIR "/agent_manager";
const std::string kModule = GALATEA_BIN_DIR "/test_module";

class MqttTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!Mosquitto::Installed()) GTEST_SKIP() << "no mosquitto here (Debian package mosquitto)";
  }
  /// A hub with the module @TEST, known as `agent` at the broker. `more`: keys of "mqtt".
  std::unique_ptr<Process> Hub(const std::string& agent, unsigned short port,
                               const std::string& more = "", const std::string& kind = "tcp") {
    const std::string file = folder_ / (agent + ".json");
    std::ofstream(file) << "{\"mqtt\": {\"broker\": \"" << kind << ":127.0.0.1:" << port
                        << "\", \"agent\": \"" << agent << "\"" << more
                        << "}, \"modules\": [{\"name\": \"TEST\", \"command\": [\"" << kModule
                        << "\"]}]}";
    auto hub = std::make_unique<Process>(std::vector<std::string>{kHub, "--config", file});
    hub->WriteLine("to @TEST set#ready X = 0");
    EXPECT_TRUE(hub->Expect("rep#ready X = 0")) << hub->Seen() << hub->ErrorText();
    return hub;
  }
  /// Prints "TOPIC PAYLOAD" for what comes below galatea/.
  static std::unique_ptr<Process> Listen(unsigned short port, const std::string& filter) {
    return std::make_unique<Process>(std::vector<std::string>{
        "mosquitto_sub", "-V", "5", "-p", std::to_string(port), "-v", "-t", filter});
  }
  static std::unique_ptr<Process> Command(unsigned short port, const std::string& topic,
                                          const std::string& payload) {
    return std::make_unique<Process>(std::vector<std::string>{
        "mosquitto_rr", "-V", "5", "-p", std::to_string(port), "-t", topic, "-e",
        "test/answers/" + std::to_string(getpid()), "-m", payload, "-W", "20"});
  }
  std::string Secret(const std::string& text) const {
    const std::string file = folder_ / "password";
    std::ofstream(file) << text << "\n";
    chmod(file.c_str(), 0600);
    return file;
  }
  support::TempDir folder_;
};

TEST_F(MqttTest, AModuleOfAnotherAgentIsSetAskedAndHeard) {
  Mosquitto broker;
  const auto hall = Hub("HALL", broker.port()), lobby = Hub("LOBBY", broker.port());
  for (Process* hub : {hall.get(), lobby.get()})
    ASSERT_TRUE(hub->ExpectError("mqtt: ONLINE")) << hub->ErrorText();
  hall->WriteLine("to @LOBBY/TEST set#1 X = 5");
  EXPECT_TRUE(hall->Expect("From @LOBBY/TEST rep#1 X = 5")) << hall->Seen() << hall->ErrorText();
  hall->WriteLine("to @LOBBY/TEST set#2 X = five");
  EXPECT_TRUE(hall->Expect("rep#2 X.error = BAD_VALUE")) << hall->Seen();
  hall->WriteLine("to @NOWHERE/TEST set#3 X = 5");
  EXPECT_TRUE(
      hall->Expect("rep#3 X.error = UNAVAILABLE @NOWHERE/TEST has gone (there is no such "
                   "agent at the broker)"))
      << hall->Seen();
  hall->WriteLine("set#4 Subscribe = LOBBY/TEST");
  ASSERT_TRUE(hall->Expect("rep#4 Subscribe"));
  hall->WriteLine("to @LOBBY/TEST prop#5 X = AutoOutput");
  ASSERT_TRUE(hall->Expect("rep#5 X")) << hall->Seen();
  lobby->WriteLine("to @TEST set X = 7");
  EXPECT_TRUE(hall->Expect("From @LOBBY/TEST rep X = 7")) << hall->Seen();
  hall->CloseInput();
  EXPECT_EQ(hall->Wait(), 0);
}

TEST_F(MqttTest, AnyClientOfTheBrokerSeesSlotsAndSpeaksToModules) {
  Mosquitto broker;
  const auto hub = Hub("HALL", broker.port());
  const auto listener = Listen(broker.port(), "galatea/HALL/#");
  EXPECT_TRUE(listener->Expect("galatea/HALL/$modules AM AM-MCL FS-MCL TEST"))
      << listener->Seen() << hub->ErrorText();
  EXPECT_TRUE(Command(broker.port(), "galatea/HALL/$do/TEST", "prop X = AutoOutput")
                  ->Expect("rep X = AutoOutput"));
  EXPECT_TRUE(Command(broker.port(), "galatea/HALL/TEST/X/set", "9")->Expect("rep X = 9"));
  EXPECT_TRUE(listener->Expect("galatea/HALL/TEST/X 9")) << listener->Seen();
  const auto late = Listen(broker.port(), "galatea/HALL/TEST/X");
  EXPECT_TRUE(late->Expect("galatea/HALL/TEST/X 9")) << "the value stands there";
  EXPECT_TRUE(Command(broker.port(), "galatea/HALL/TEST/X/inq", "-")->Expect("rep X = 9"));
  EXPECT_TRUE(Command(broker.port(), "galatea/HALL/$do/TEST", "jump")
                  ->Expect("rep Error = UNKNOWN_COMMAND"));
  EXPECT_TRUE(hub->ExpectError("mqtt: refused 'galatea/HALL/$do/TEST'")) << hub->ErrorText();
}

TEST_F(MqttTest, AnAgentThatDiesIsSaidToBeLostAndItsRequestsEnd) {
  Mosquitto broker;
  const auto hall = Hub("HALL", broker.port()), lobby = Hub("LOBBY", broker.port());
  for (Process* hub : {hall.get(), lobby.get()})
    ASSERT_TRUE(hub->ExpectError("mqtt: ONLINE")) << hub->ErrorText();
  const auto listener = Listen(broker.port(), "galatea/LOBBY/$state");
  ASSERT_TRUE(listener->Expect("ONLINE"));
  hall->WriteLine("to @LOBBY/TEST set#1 Work = 600000");
  hall->WriteLine("to @LOBBY/TEST inq#2 X");
  ASSERT_TRUE(hall->Expect("rep#2 X = 0")) << hall->Seen() << hall->ErrorText();
  lobby->Kill();
  EXPECT_TRUE(listener->Expect("galatea/LOBBY/$state LOST")) << listener->Seen();
  EXPECT_TRUE(
      hall->Expect("rep#1 Work.error = UNAVAILABLE @LOBBY/TEST has gone (the agent LOBBY "
                   "is LOST)"))
      << hall->Seen();
}

TEST_F(MqttTest, AnAgentThatStopsSaysSo) {
  Mosquitto broker;
  const auto hub = Hub("HALL", broker.port());
  const auto listener = Listen(broker.port(), "galatea/HALL/$state");
  ASSERT_TRUE(listener->Expect("ONLINE")) << hub->ErrorText();
  hub->CloseInput();
  EXPECT_EQ(hub->Wait(), 0);
  EXPECT_TRUE(listener->Expect("galatea/HALL/$state OFFLINE")) << listener->Seen();
}

TEST_F(MqttTest, ABrokerThatComesBackIsFoundAgainAndHasEveryValue) {
  Mosquitto broker;
  const auto hub = Hub("HALL", broker.port());
  ASSERT_TRUE(hub->ExpectError("mqtt: ONLINE")) << hub->ErrorText();
  broker.Stop();
  ASSERT_TRUE(hub->ExpectError("mqtt: AWAY The connection was lost")) << hub->ErrorText();
  hub->WriteLine("to @TEST prop#1 X = AutoOutput");
  ASSERT_TRUE(hub->Expect("rep#1 X"));
  hub->WriteLine("to @TEST set#2 X = 3");
  ASSERT_TRUE(hub->Expect("rep#2 X = 3"));
  hub->WriteLine("to @LOBBY/TEST set#3 X = 3");
  EXPECT_TRUE(hub->Expect("rep#3 X.error = UNAVAILABLE @LOBBY/TEST cannot be reached"));
  broker.Start();  // it has forgotten everything
  const auto listener = Listen(broker.port(), "galatea/HALL/#");
  EXPECT_TRUE(listener->Expect("galatea/HALL/TEST/X 3")) << listener->Seen() << hub->ErrorText();
}

TEST_F(MqttTest, WithTheWrongPasswordTheHubWorksAndSaysWhyNobodyElseIsThere) {
  const std::string users = folder_ / "users";
  ASSERT_EQ(std::system(("mosquitto_passwd -b -c " + users + " hall right-password").c_str()), 0);
  Mosquitto broker("password_file " + users + "\nallow_anonymous false\n");
  const std::string right =
      ", \"user\": \"hall\", \"password_file\": \"" + Secret("right-password") + "\"";
  auto hub = Hub("HALL", broker.port(), right);
  EXPECT_TRUE(hub->ExpectError("mqtt: ONLINE")) << hub->ErrorText();
  Secret("wrong-password");
  hub = Hub("HALL", broker.port(), right);
  EXPECT_TRUE(hub->ExpectError("mqtt: AWAY refused: Not authorized")) << hub->ErrorText();
}

TEST_F(MqttTest, ByTlsOnlyWhoHasACertificateComesIn) {
  const support::Certificates files(folder_ / "");
  files.Sign("broker");
  files.Sign("hall");
  Mosquitto broker("allow_anonymous true\nrequire_certificate true\ncafile " +
                   files.Certificate("ca") + "\ncertfile " + files.Certificate("broker") +
                   "\nkeyfile " + files.Key("broker") + "\n");
  const std::string authority = ", \"authority\": \"" + files.Certificate("ca") + "\"";
  auto hub = Hub("HALL", broker.port(),
                 authority + ", \"certificate\": \"" + files.Certificate("hall") +
                     "\", \"key\": \"" + files.Key("hall") + "\"",
                 "tls");
  EXPECT_TRUE(hub->ExpectError("mqtt: ONLINE tls:")) << hub->ErrorText();
  hub = Hub("HALL2", broker.port(), authority, "tls");
  EXPECT_TRUE(hub->ExpectError("mqtt: AWAY connecting to tls:")) << hub->ErrorText();
  EXPECT_TRUE(hub->ExpectError("\nagent_manager: mqtt: AWAY ")) << hub->ErrorText();
  EXPECT_EQ(hub->ErrorText().find("ONLINE"), std::string::npos);
}

TEST_F(MqttTest, ANameThatIsTakenIsLeftToWhoHasIt) {
  Mosquitto broker;
  const auto first = Hub("HALL", broker.port());
  ASSERT_TRUE(first->ExpectError("mqtt: ONLINE")) << first->ErrorText();
  const auto second = Hub("HALL", broker.port());
  EXPECT_TRUE(second->ExpectError("mqtt: AWAY another hub goes by the name HALL there"))
      << second->ErrorText();
  EXPECT_TRUE(Command(broker.port(), "galatea/HALL/TEST/X/set", "4")->Expect("rep X = 4"));
  first->WriteLine("to @TEST inq#1 X");
  EXPECT_TRUE(first->Expect("rep#1 X = 4")) << first->Seen();
  EXPECT_EQ(first->ErrorText().find("AWAY The"), std::string::npos) << first->ErrorText();
}

}  // namespace
