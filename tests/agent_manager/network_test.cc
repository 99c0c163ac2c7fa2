// The hub and its modules over TCP and TLS, and those who have no business there.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>

#include "tests/agent_manager/programs.h"
#include "tests/support/certificates.h"
#include "tests/support/process.h"
#include "vm_protocol/runtime/credentials.h"

namespace {

using support::Process;
using support::SocketClient;

const std::string kToken = "a token nobody guesses";

class NetworkTest : public testing::Test {
 protected:
  NetworkTest() { WriteToken(token_file_, kToken); }
  static void WriteToken(const std::string& path, const std::string& token, mode_t mode = 0600) {
    std::ofstream(path) << token << "\n";
    chmod(path.c_str(), mode);
  }
  /// A hub that listens as `listen` says (JSON), on a port of its own choice.
  std::unique_ptr<Process> StartHub(const std::string& listen, const std::string& more = "") {
    const std::string path = folder_ / "config.json";
    std::ofstream(path) << "{\"listen\": [" << listen << "]" << more << "}";
    auto hub = std::make_unique<Process>(std::vector<std::string>{kHub, "--config", path});
    if (!hub->ExpectError("listening on ") || !hub->ExpectError("\n")) return hub;
    const std::string text = hub->ErrorText();
    const std::size_t colon = text.find("127.0.0.1:");
    port_ = static_cast<unsigned short>(std::atoi(text.c_str() + colon + 10));
    return hub;
  }
  std::string WithToken() const {
    return "{\"at\": \"tcp:127.0.0.1:0\", \"token_file\": \"" + token_file_ + "\"}";
  }
  std::string WithCertificates(const std::string& more) const {
    return "{\"at\": \"tls:127.0.0.1:0\", \"certificate\": \"" + certificates_->Certificate("hub") +
           "\", \"key\": \"" + certificates_->Key("hub") + "\"" + more + "}";
  }
  void MakeCertificates() {
    certificates_ = std::make_unique<support::Certificates>(folder_.path());
    certificates_->Sign("hub");
    certificates_->Sign("face");
  }
  /// Shows the token; the lines said, for one who listens in.
  std::vector<std::string> Enter(SocketClient& client) {
    const auto asked = client.Expect("asks for the token, ");
    if (!asked) return {};
    const std::string theirs = asked->substr(asked->rfind(' ') + 1), ours = vm::MakeNonce();
    const std::string line =
        "set#token Token = " + ours + " " + vm::TokenProof(kToken, "caller", theirs, ours);
    client.WriteLine(line);
    const auto answer = client.Expect("rep#token Token");
    EXPECT_EQ(answer, "rep#token Token = " + vm::TokenProof(kToken, "listener", theirs, ours));
    return {line};
  }
  void ExpectStillWell(Process& hub) {
    const auto client = SocketClient::Tcp(port_);
    Enter(*client);
    client->WriteLine("inq#well Clock");
    EXPECT_TRUE(client->Expect("rep#well Clock = ")) << hub.ErrorText();
  }

  support::TempDir folder_;
  std::string token_file_ = folder_ / "token";
  std::unique_ptr<support::Certificates> certificates_;
  unsigned short port_ = 0;
};

TEST_F(NetworkTest, WhoHasNoTokenOrAWrongOneIsRefusedAndNothingItSaysIsHeard) {
  const auto hub = StartHub(WithToken());
  const auto nothing = SocketClient::Tcp(port_);
  nothing->WriteLine("to @AM set Run = EXIT");
  EXPECT_TRUE(nothing->Expect("Token.error = ACCESS refused")) << hub->ErrorText();
  nothing->ReadAll();
  EXPECT_TRUE(nothing->AtEnd()) << "the connection is closed";
  const auto wrong = SocketClient::Tcp(port_);
  const auto asked = wrong->Expect("asks for the token, ");
  ASSERT_TRUE(asked);
  const std::string theirs = asked->substr(asked->rfind(' ') + 1), ours = vm::MakeNonce();
  wrong->WriteLine("set#token Token = " + ours + " " +
                   vm::TokenProof("some other token", "caller", theirs, ours) +
                   "\nto @AM set Run = EXIT");
  EXPECT_TRUE(wrong->Expect("Token.error = ACCESS refused"));
  EXPECT_TRUE(hub->ExpectError("it does not show a token"));
  EXPECT_TRUE(hub->ExpectError("it shows a wrong token"));
  hub->WriteLine("inq#r Refused");
  EXPECT_TRUE(hub->Expect("rep#r Refused = 2 tcp:127.0.0.1:")) << hub->Seen();
  ExpectStillWell(*hub);
}

TEST_F(NetworkTest, AHandshakeThatWasOverheardIsNoUseASecondTime) {
  const auto hub = StartHub(WithToken());
  const auto first = SocketClient::Tcp(port_);
  const auto said = Enter(*first);
  ASSERT_EQ(said.size(), 1u);
  const auto second = SocketClient::Tcp(port_);
  second->WriteLine(said.front());
  EXPECT_TRUE(second->Expect("Token.error = ACCESS refused"));
  EXPECT_TRUE(hub->ExpectError("it shows a wrong token"));
  ExpectStillWell(*hub);
}

TEST_F(NetworkTest, OversizedLinesAreRefusedBeforeAndAfterTheDoor) {
  const auto hub = StartHub(WithToken());
  const auto outside = SocketClient::Tcp(port_);
  outside->Write(std::string(1u << 20, 'x'));
  EXPECT_TRUE(hub->ExpectError("refused 127.0.0.1")) << hub->ErrorText();
  const auto inside = SocketClient::Tcp(port_);
  Enter(*inside);
  inside->Write(std::string(1u << 20, 'x') + "\ninq#1 Clock\n");
  EXPECT_TRUE(inside->Expect("rep Error = TOO_LONG"));
  EXPECT_TRUE(inside->Expect("rep#1 Clock = "));
  ExpectStillWell(*hub);
}

TEST_F(NetworkTest, NamesAndSendersCannotBeTaken) {
  const auto hub = StartHub(WithToken());
  const auto a = SocketClient::Tcp(port_), b = SocketClient::Tcp(port_);
  Enter(*a);
  Enter(*b);
  a->WriteLine("to @AM set#1 Name = FACE");
  ASSERT_TRUE(a->Expect("rep#1 Name = FACE"));
  b->WriteLine("to @AM set#1 Name = FACE");
  EXPECT_TRUE(b->Expect("rep#1 Name.error = BUSY the name @FACE is taken"));
  b->WriteLine("to @AM set#2 Name = AM");
  EXPECT_TRUE(b->Expect("rep#2 Name.error = BUSY"));
  b->WriteLine("from @CONSOLE to @FACE tell hello");
  const auto heard = a->Expect("tell hello");
  ASSERT_TRUE(heard);
  EXPECT_TRUE(heard->starts_with("From @CLIENT")) << *heard;
}

TEST_F(NetworkTest, AModuleComesWithTheToken) {
  const auto hub = StartHub(WithToken());
  Process module({kModule, "--connect", "tcp:127.0.0.1:" + std::to_string(port_), "--name", "FAR",
                  "--token-file", token_file_});
  hub->WriteLine("set Subscribe = FAR");
  ASSERT_TRUE(hub->Expect("From @FAR rep Run = LIVE")) << module.ErrorText() << hub->ErrorText();
  hub->WriteLine("to @FAR set#1 X = 5");
  EXPECT_TRUE(hub->Expect("From @FAR rep#1 X = 5"));
  const std::string wrong = folder_ / "wrong";
  WriteToken(wrong, "another token of length");
  Process stranger(
      {kModule, "--connect", "tcp:127.0.0.1:" + std::to_string(port_), "--token-file", wrong});
  EXPECT_EQ(stranger.Wait(), 1);
  EXPECT_NE(stranger.ErrorText().find("the token was refused"), std::string::npos)
      << stranger.ErrorText();
}

TEST_F(NetworkTest, OverTlsACertificateIsEnoughAndNoneIsTooLittle) {
  MakeCertificates();
  const auto hub =
      StartHub(WithCertificates(", \"authority\": \"" + certificates_->Certificate("ca") + "\""));
  const std::string at = "tls:127.0.0.1:" + std::to_string(port_);
  Process module({kModule, "--connect", at, "--name", "FAR", "--authority",
                  certificates_->Certificate("ca"), "--certificate",
                  certificates_->Certificate("face"), "--key", certificates_->Key("face")});
  ASSERT_TRUE(hub->Expect("From @FAR rep Run = LIVE")) << module.ErrorText() << hub->ErrorText();
  hub->WriteLine("to @FAR set#1 X = " + std::to_string(6));
  EXPECT_TRUE(hub->Expect("From @FAR rep#1 X = 6"));
  Process bare({kModule, "--connect", at, "--authority", certificates_->Certificate("ca")});
  EXPECT_EQ(bare.Wait(), 1) << "it hears the end at once";
  EXPECT_NE(bare.ErrorText().find("ended the connection without a word"), std::string::npos);
  EXPECT_TRUE(hub->ExpectError("refused 127.0.0.1")) << hub->ErrorText();
  const auto plain = SocketClient::Tcp(port_);
  plain->WriteLine("to @AM set Run = EXIT");
  plain->ReadAll();
  EXPECT_TRUE(plain->AtEnd());
  // An authority of the same name, but not ours.
  const support::TempDir elsewhere;
  support::Certificates others(elsewhere.path());
  others.Sign("face");
  Process forged({kModule, "--connect", at, "--authority", certificates_->Certificate("ca"),
                  "--certificate", others.Certificate("face"), "--key", others.Key("face")});
  EXPECT_TRUE(forged.Wait());
  Process wary({kModule, "--connect", at, "--authority", others.Certificate("ca")});
  EXPECT_EQ(wary.Wait(), 1) << "a module does not talk to a hub it cannot trust";
  EXPECT_NE(wary.ErrorText().find("no TLS agreement"), std::string::npos) << wary.ErrorText();
  hub->WriteLine("to @FAR set#2 X = 7");
  EXPECT_TRUE(hub->Expect("From @FAR rep#2 X = 7")) << "the others are not disturbed";
}

TEST_F(NetworkTest, TheHubGoesToAModuleThatListensWithTlsAndToken) {
  MakeCertificates();
  Process module({kModule, "--listen", "tls:127.0.0.1:0", "--certificate",
                  certificates_->Certificate("hub"), "--key", certificates_->Key("hub"),
                  "--token-file", token_file_});
  ASSERT_TRUE(module.ExpectError("listening on tls:127.0.0.1:")) << module.ErrorText();
  const std::string text = module.ErrorText();
  const std::string at = text.substr(text.find("tls:"), text.find('\n') - text.find("tls:"));
  const auto hub = StartHub("\"tcp:127.0.0.1:0\"",
                            ", \"modules\": [{\"name\": \"FAR\", \"connect\": \"" + at +
                                "\", \"token_file\": \"" + token_file_ + "\", \"authority\": \"" +
                                certificates_->Certificate("ca") + "\"}]");
  ASSERT_TRUE(hub->Expect("From @FAR rep Run = LIVE")) << hub->ErrorText() << module.ErrorText();
  // More than fits into the buffers between them, both ways.
  const std::string text_value(60000, 'x');
  for (int i = 0; i < 40; ++i)
    hub->WriteLine("to @FAR def#" + std::to_string(i) + " Long" + std::to_string(i) + " = " +
                   text_value);
  for (int i = 0; i < 40; ++i)
    ASSERT_TRUE(hub->Expect("rep#" + std::to_string(i) + " Long" + std::to_string(i) + " = xxx"))
        << i << hub->ErrorText();
}

TEST_F(NetworkTest, NothingListensForOtherMachinesUnguarded) {
  const std::string path = folder_ / "config.json";
  std::ofstream(path) << "{\"listen\": [\"tcp:0.0.0.0:0\"]}";
  Process hub({kHub, "--config", path});
  EXPECT_EQ(hub.Wait(), 1);
  EXPECT_NE(hub.ErrorText().find("listen[0]: tcp:0.0.0.0:0 is open to other machines"),
            std::string::npos)
      << hub.ErrorText();
  Process module({kModule, "--listen", "tcp:0.0.0.0:0"});
  EXPECT_EQ(module.Wait(), 1);
  WriteToken(token_file_, kToken, 0644);
  Process careless({kModule, "--listen", "tcp:127.0.0.1:0", "--token-file", token_file_});
  EXPECT_EQ(careless.Wait(), 1);
  EXPECT_NE(careless.ErrorText().find("is open to others"), std::string::npos);
}

}  // namespace
