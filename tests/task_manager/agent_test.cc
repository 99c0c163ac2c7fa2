// The agent platform with the real hub and the voice's, the ear's and a face-less stack: the
// programs as people run them.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/support/certificates.h"
#include "tests/support/process.h"
#include "tests/task_manager/http_server.h"

namespace vxml_test {
namespace {

class AgentTest : public ::testing::Test {
 protected:
  AgentTest() {
    const std::string bin = GALATEA_BIN_DIR;
    std::ofstream(folder_ / "hub.json")
        << "{\"clock\": \"virtual\", \"listen\": [{\"role\": \"owner\", \"at\": \"unix:"
        << folder_ / "hub"
        << "\"}], \"modules\": [{\"name\": \"SSM\", \"command\": [\"" << bin
        << "/ssm_stub\"]}, {\"name\": \"SRM\", \"command\": [\"" << bin << "/srm_stub\"]}]}";
    hub_ = std::make_unique<support::Process>(
        std::vector<std::string>{bin + "/agent_manager", "--config", folder_ / "hub.json", "--log",
                                 folder_ / "log"},
        support::Process::Options{.cwd = folder_.path(), .env = {}});
    hub_->WriteLine("inq#up Slots");
    EXPECT_TRUE(hub_->Expect("#up Slots"));
  }

  std::vector<std::string> Talk(const std::string& document, const std::string& script) {
    std::ofstream(folder_ / "d.vxml") << document;
    std::ofstream(folder_ / "s.txt") << script;
    support::Process dialogue(
        std::vector<std::string>{GALATEA_BIN_DIR "/task_manager", folder_ / "d.vxml", "--connect",
                                 "unix:" + (folder_ / "hub"), "--script", folder_ / "s.txt"},
        support::Process::Options{.cwd = folder_.path(), .env = {}});
    auto lines = dialogue.ReadAll();
    EXPECT_EQ(dialogue.Wait(), 0) << dialogue.ErrorText();
    return lines;
  }

  /// The hub ends first: only then is its log sure to be whole.
  std::string Log() {
    hub_->Terminate();
    hub_->Wait();
    std::ifstream file(folder_ / "log");
    return {std::istreambuf_iterator<char>(file), {}};
  }

  support::TempDir folder_;
  std::unique_ptr<support::Process> hub_;
};

std::string Form(const std::string& content) {
  return "<vxml version=\"2.1\"><form>" + content + "</form></vxml>";
}

TEST(ExamplesTest, AreFoundWithoutFault) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(GALATEA_SOURCE_DIR "/examples/dialogs")) {
    if (entry.path().extension() != ".vxml") continue;
    ++count;
    support::Process check({GALATEA_BIN_DIR "/task_manager", "--check", entry.path()});
    const auto lines = check.ReadAll();
    EXPECT_EQ(check.Wait(), 0) << entry.path();
    ASSERT_EQ(lines.size(), 1U) << entry.path() << ": " << lines[0];
    EXPECT_TRUE(lines[0].ends_with(": 0 errors, 0 warnings")) << lines[0];
  }
  EXPECT_GE(count, 6);
}

TEST(ExamplesTest, SayThatTheyHaveNotUnderstood) {
  support::TempDir folder;
  std::ofstream(folder / "script.txt") << "nomatch\nhangup\n";
  for (const auto& [name, said] : {std::pair("food_en", "I did not understand"),
                                   {"place_en", "I did not understand"},
                                   {"food_ja", "すみません"},
                                   {"place_ja", "わかりませんでした"}}) {
    support::Process dialogue(
        {GALATEA_BIN_DIR "/task_manager",
         std::string(GALATEA_SOURCE_DIR "/examples/dialogs/") + name + ".vxml", "--script",
         folder / "script.txt", "--transcript", "text"});
    std::string all;
    for (const std::string& line : dialogue.ReadAll()) all += line + "\n";
    EXPECT_NE(all.find(said), std::string::npos) << name << ":\n" << all;
  }
}

TEST(SessionsTest, AScriptThatCannotBeStoppedEndsItsSessionAndTheOthersGoOn) {
  // Nothing can interrupt this comparison of texts, which would take minutes.
  support::TempDir folder;
  std::ofstream(folder / "d.vxml") << Form(
      "<field name=\"f\" type=\"digits\"><filled><if cond=\"f == 2\"><script>"
      "'a'.repeat(1e7).indexOf('a'.repeat(5e6) + 'b')</script></if><exit expr=\"f\"/></filled>"
      "</field>");
  for (const char* digit : {"1", "2", "3"}) {
    std::ofstream(folder / digit) << "dtmf " << digit << "#\n";
  }
  const std::string document = folder / "d.vxml";
  support::Process one({GALATEA_BIN_DIR "/task_manager", document, "--script", folder / "2"});
  const auto lines = one.ReadAll();
  EXPECT_EQ(one.Wait(), 1);
  ASSERT_GE(lines.size(), 2U) << one.ErrorText();
  EXPECT_NE(lines[lines.size() - 2].find("a script could not be stopped"), std::string::npos);
  EXPECT_EQ(lines.back(), R"({"type":"exit","reason":"error.noresource","value":null})");

  support::Process three({GALATEA_BIN_DIR "/task_manager", document, "--sessions", "3", "--script",
                          folder / "1", "--script", folder / "2", "--script", folder / "3"});
  std::vector<std::string> ends;
  for (const std::string& line : three.ReadAll()) {
    if (line.find("\"exit\"") != std::string::npos) ends.push_back(line);
  }
  EXPECT_EQ(three.Wait(), 1);
  ASSERT_EQ(ends.size(), 3U) << three.ErrorText();
  EXPECT_NE(ends[0].find("\"session\":1,"), std::string::npos) << ends[0];
  EXPECT_NE(ends[0].find("\"value\":\"1\""), std::string::npos) << ends[0];
  EXPECT_NE(ends[1].find("error.noresource"), std::string::npos) << ends[1];
  EXPECT_NE(ends[2].find("\"value\":\"3\""), std::string::npos) << ends[2];
}

TEST_F(AgentTest, SpeaksHearsAndMovesTheFaceThroughTheHub) {
  const auto lines = Talk(
      "<vxml version=\"2.1\"><form><field name=\"f\" type=\"boolean\"><prompt>Do you <emotion "
      "type=\"HAPPY\" value=\"80\">like it</emotion>?</prompt><nomatch>Yes or no?<reprompt/>"
      "</nomatch><filled><prompt>Thank you.</prompt><exit "
      "expr=\"f\"/></filled></field></form></vxml>",
      "say perhaps\nsay yes\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("\"value\":true"), std::string::npos) << lines.back();
  const std::string log = Log();
  EXPECT_NE(log.find("Do you<BOOKMARK MARK=\"d0\"/> like it<BOOKMARK MARK=\"d1\"/> ?"),
            std::string::npos);
  bool smiled = false;
  for (const std::string& line : lines) {
    smiled = smiled || line.find("set FaceExp = HAPPY 1 80 0") != std::string::npos;
  }
  EXPECT_TRUE(smiled);
  EXPECT_NE(log.find("Thank you."), std::string::npos);
}

TEST_F(AgentTest, TheActiveGrammarsAreLoadedIntoTheEar) {
  const auto lines = Talk(
      "<vxml version=\"2.1\"><form><field name=\"f\"><grammar root=\"r\"><rule id=\"r\"><item "
      "repeat=\"0-1\">some</item><one-of><item>green tea</item><item>coffee</item></one-of>"
      "</rule></grammar><filled><exit expr=\"f\"/></filled></field></form></vxml>",
      "say some green tea\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("some green tea"), std::string::npos) << lines.back();
  EXPECT_NE(Log().find("Grammar.load = dialog_DM [some] (green tea | coffee)"), std::string::npos);
}

TEST_F(AgentTest, AnInterruptionStopsThePromptAndItsLaterMarksAreNotReached) {
  const auto lines = Talk(
      "<vxml version=\"2.1\"><form><field name=\"f\" type=\"boolean\"><prompt>Well <mark "
      "name=\"early\"/> this is a very long question with a great many words in it that nobody "
      "wants to hear to its very end, so we say yes <mark name=\"late\"/> now</prompt><filled>"
      "<exit expr=\"f &amp;&amp; f$.markname=='early'\"/></filled></field></form></vxml>",
      "say at=2s yes\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("\"value\":true"), std::string::npos) << lines.back();
  EXPECT_NE(Log().find("Speak = STOP"), std::string::npos);
}

TEST_F(AgentTest, SoundFilesArePlayedByTheVoiceAlsoThoseForSnd) {
  const std::string header(
      "RIFF\x24\x7d\0\0WAVEfmt \x10\0\0\0\1\0\1\0\x80\x3e\0\0\0\x7d\0\0\2\0\x10\0data\0\x7d\0\0",
      44);
  std::ofstream(folder_ / "bell.wav", std::ios::binary) << header << std::string(32000, '\0');
  Talk(
      "<vxml version=\"2.1\"><form><block><prompt>before <audio src=\"bell.wav\"/> after</prompt>"
      "<native>to @SND set Play = " +
          (folder_ / "bell.wav") + "</native></block></form></vxml>",
      "silence\n");
  const std::string log = Log();
  const std::string play = "<speak><audio src=\"" + (folder_ / "bell.wav");
  const std::size_t first = log.find(play);
  EXPECT_LT(log.find("Speak = before"), first);
  EXPECT_LT(first, log.find("Speak = after"));
  EXPECT_NE(log.find(play, log.find("Speak = after")), std::string::npos);
  EXPECT_NE(log.find("tell end " + (folder_ / "bell.wav")), std::string::npos);
}

TEST_F(AgentTest, TheEscapesOfASoundsUriAreNoPartOfItsFile) {
  std::ofstream(folder_ / "two bells.wav") << "RIFF";
  Talk(Form("<block><prompt><audio src=\"two%20bells.wav\"/></prompt></block>"), "silence\n");
  EXPECT_NE(Log().find("tell start " + (folder_ / "two bells.wav")), std::string::npos);
}

TEST_F(AgentTest, SoundsThatCameOverTheNetAreKeptForTheVoice) {
  // 16 kHz, 16 bit, two samples of silence.
  Talk(
      "<vxml version=\"2.1\"><form><block><prompt>before <audio src=\"data:audio/x-wav;base64,"
      "UklGRigAAABXQVZFZm10IBAAAAABAAEAgD4AAAB9AAACABAAZGF0YQQAAAAAAAAA\"/> after</prompt>"
      "</block></form></vxml>",
      "silence\n");
  const std::string log = Log();
  const std::size_t play = log.find("<speak><audio src=\"/");
  ASSERT_NE(play, std::string::npos);
  const std::size_t begin = log.find('/', play);
  const std::string file = log.substr(begin, log.find('"', begin) - begin);
  EXPECT_NE(file.find("galatea-sounds-"), std::string::npos) << file;
  EXPECT_FALSE(std::ifstream(file).good()) << file << " is still there";
}

TEST_F(AgentTest, TheHubIsReachedOverTlsWithAToken) {
  support::Certificates certificates(folder_.path());
  certificates.Sign("distant");  // its files are named so, and "hub" is a socket
  std::ofstream(folder_ / "token") << "a token nobody guesses\n";
  chmod((folder_ / "token").c_str(), 0600);
  std::ofstream(folder_ / "far.json")
      << "{\"listen\": [{\"role\": \"owner\", \"at\": \"tls:127.0.0.1:0\", \"certificate\": \""
      << certificates.Certificate("distant") << "\", \"key\": \"" << certificates.Key("distant")
      << "\", \"token_file\": \"" << (folder_ / "token") << "\"}], \"modules\": [{\"name\": "
      << "\"SSM\", \"command\": [\"" GALATEA_BIN_DIR "/ssm_stub\"]}, {\"name\": \"SRM\", "
      << "\"command\": [\"" GALATEA_BIN_DIR "/srm_stub\"]}]}";
  support::Process hub({GALATEA_BIN_DIR "/agent_manager", "--config", folder_ / "far.json"});
  ASSERT_TRUE(hub.ExpectError("listening on ") && hub.ExpectError("\n")) << hub.ErrorText();
  const std::string said = hub.ErrorText();
  const std::size_t at = said.find("127.0.0.1:");
  ASSERT_NE(at, std::string::npos) << said;
  const std::string port = std::to_string(std::atoi(said.c_str() + at + 10));
  std::ofstream(folder_ / "d.vxml")
      << "<vxml version=\"2.1\"><form><field name=\"f\" type=\"boolean\"><prompt>Is it "
         "you?</prompt><filled><exit expr=\"f\"/></filled></field></form></vxml>";
  std::ofstream(folder_ / "s.txt") << "say yes\n";
  const auto talk = [&](const std::string& authority) {
    return support::Process({GALATEA_BIN_DIR "/task_manager", folder_ / "d.vxml", "--connect",
                             "tls:127.0.0.1:" + port, "--authority", authority, "--token-file",
                             folder_ / "token", "--script", folder_ / "s.txt"});
  };
  support::Process dialogue = talk(certificates.Certificate("ca"));
  const auto lines = dialogue.ReadAll();
  EXPECT_EQ(dialogue.Wait(), 0) << dialogue.ErrorText();
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("\"value\":true"), std::string::npos) << lines.back();
  support::Process wary = talk(certificates.Certificate("distant"));  // not its authority
  EXPECT_NE(wary.Wait(), 0);
  EXPECT_NE(wary.ErrorText().find("no TLS agreement"), std::string::npos) << wary.ErrorText();
}

TEST_F(AgentTest, CommandsBesideTheWordsStartWithTheVoice) {
  Talk(
      "<vxml version=\"2.0\"><form><block><prompt><all-of><media type=\"face\"><native>sleep 0.1"
      "</native><native>to @AM-MCL set Emotion = SAD</native></media><media type=\"voice\">hello "
      "over there</media></all-of></prompt></block></form></vxml>",
      "silence\n");
  const std::string log = Log();
  const std::size_t speaking = log.find("From @SSM rep Speak.stat = SPEAKING");
  const std::size_t sent = log.find("AM-MCL\tAM-MCL\tto @AM-MCL set Emotion = SAD");
  EXPECT_NE(sent, std::string::npos);
  EXPECT_LT(speaking, sent);
}

TEST_F(AgentTest, WithoutAttentionTheFaceIsLeftAlone) {
  Talk(
      "<vxml version=\"2.1\"><property name=\"attention\" value=\"false\"/><form><field "
      "name=\"f\" type=\"boolean\"><filled><exit/></filled></field></form></vxml>",
      "say yes\n");
  EXPECT_EQ(Log().find("Gaze"), std::string::npos);
}

TEST_F(AgentTest, TransfersAndObjectsAreRefusedWithTheirEvents) {
  const auto lines = Talk(
      "<vxml version=\"2.1\"><form><var name=\"n\" expr=\"0\"/><transfer name=\"t\" "
      "dest=\"tel:1\" bridge=\"true\"><catch event=\"error.unsupported.transfer.bridge\"><assign "
      "name=\"t\" expr=\"1\"/><assign name=\"n\" expr=\"n+1\"/></catch></transfer><object "
      "name=\"o\" classid=\"x\"><catch event=\"error.unsupported.objectname\"><exit "
      "expr=\"n+1\"/></catch></object></form></vxml>",
      "silence\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("\"value\":2"), std::string::npos) << lines.back();
}

/// The shadow variables of a recording r, one after the other.
const char* const kShadow =
    "<filled><exit expr=\"r$.duration+' '+r$.size+' '+r$.termchar+' '+r$.maxtime\"/></filled>";

/// The file of the nth sound played, "" if there are not so many.
std::string Played(const std::string& log, int number) {
  std::size_t at = 0;
  for (int i = 0; i < number; ++i) {
    at = log.find("tell start ", at + 1);
    if (at == std::string::npos) return "";
  }
  const std::size_t begin = at + 11;
  return log.substr(begin, log.find('\n', begin) - begin);
}

TEST_F(AgentTest, ARecordingIsKeptPlayedBackAndGoneAtTheEnd) {
  const auto lines =
      Talk(Form("<record name=\"r\" beep=\"true\" maxtime=\"10s\"><prompt>Speak.</prompt></record>"
                "<block><prompt>You said <audio expr=\"r\"/> I repeat <value expr=\"r\"/></prompt>"
                "<exit expr=\"r$.duration+' '+r$.size+' '+r$.termchar+' '+r$.maxtime\"/></block>"),
           "record 3s key=#\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("3000 96044 # false"), std::string::npos) << lines.back();
  const std::string log = Log();
  EXPECT_NE(Played(log, 1).find("/galatea-sounds-"), std::string::npos);
  EXPECT_NE(Played(log, 1).find(".au"), std::string::npos) << "the beep";
  EXPECT_LT(log.find("Speak = Speak."), log.find(Played(log, 1)));
  EXPECT_LT(log.find(Played(log, 1)), log.find("Input.sound = 3000"));
  const std::string file = Played(log, 2);
  EXPECT_NE(file.find("/utterance-1.wav"), std::string::npos) << file;
  EXPECT_EQ(Played(log, 3), file);
  EXPECT_NE(log.find("tell end " + file), std::string::npos);
  EXPECT_FALSE(std::ifstream(file).good()) << file << " is still there";
  EXPECT_NE(log.find("Listen.keep = NONE"), std::string::npos);
}

TEST_F(AgentTest, ARecordingEndsAtItsLongestTime) {
  const auto lines =
      Talk(Form("<record name=\"r\" maxtime=\"2s\">" + std::string(kShadow) + "</record>"),
           "record 5s key=#\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("2000 64044 null true"), std::string::npos) << lines.back();
  EXPECT_NE(Log().find("Listen.longest = 20000"), std::string::npos) << "as before";
}

TEST_F(AgentTest, KeysDoNotEndARecordingWithoutDtmfterm) {
  const auto lines = Talk(Form("<record name=\"r\" maxtime=\"5s\" dtmfterm=\"false\">" +
                               std::string(kShadow) + "</record>"),
                          "record 1s key=5\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("1000 32044 null false"), std::string::npos) << lines.back();
}

TEST_F(AgentTest, ARecordingNobodySpeaksToIsNoInput) {
  const auto lines =
      Talk(Form("<record name=\"r\"><noinput><exit expr=\"'nobody'\"/></noinput></record>"),
           "silence\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("nobody"), std::string::npos) << lines.back();
}

TEST_F(AgentTest, AFormatTheEarDoesNotWriteIsRefusedWithItsEvent) {
  const auto lines =
      Talk(Form("<record name=\"r\" type=\"audio/basic\"><catch "
                "event=\"error.unsupported.format\"><exit expr=\"'refused'\"/></catch></record>"),
           "record 3s\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("refused"), std::string::npos) << lines.back();
}

TEST_F(AgentTest, WordsOfAnOuterGrammarEndARecordingThatIsNotModal) {
  const std::string document =
      "<vxml version=\"2.1\"><link event=\"enough\"><grammar root=\"r\"><rule id=\"r\">no "
      "more</rule></grammar></link><form><catch event=\"enough\"><exit expr=\"'enough'\"/></catch>"
      "<record name=\"r\" modal=\"MODAL\">" +
      std::string(kShadow) + "</record></form></vxml>";
  const auto with = [&](const std::string& modal) {
    std::string whole = document;
    const auto lines = Talk(whole.replace(whole.find("MODAL"), 5, modal), "say no more\n");
    return lines.empty() ? "" : lines.back();
  };
  EXPECT_NE(with("false").find("enough"), std::string::npos);
  EXPECT_NE(with("true").find("500 16044 null false"), std::string::npos);
}

TEST_F(AgentTest, UtterancesAreRecordedWhereThePropertySaysSo) {
  const std::string content =
      "<property name=\"recordutterance\" value=\"true\"/><field name=\"f\" type=\"boolean\"/>"
      "<block><prompt><audio expr=\"application.lastresult$.recording\"/></prompt><exit "
      "expr=\"f$.recordingduration+' '+f$.recordingsize+' '+f$.recording.type\"/></block>";
  const auto lines = Talk(Form(content), "say yes\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("250 8044 audio/x-wav"), std::string::npos) << lines.back();
  EXPECT_NE(Played(Log(), 1).find("/utterance-1.wav"), std::string::npos);
}

TEST_F(AgentTest, ARecordingIsSentByASubmission) {
  HttpServer server([](const HttpServer::Request& request) {
    const bool sent = request.body.find("RIFF") != std::string::npos &&
                      request.body.find("audio/x-wav") != std::string::npos;
    return Answer(Form("<block><exit expr=\"'" + std::string(sent ? "got " : "lost ") +
                       (request.body.size() > 32'044 ? "all" : "a part") + "'\"/></block>"));
  });
  const auto lines = Talk(Form("<record name=\"r\"/><block><submit next=\"" + server.Url("/") +
                               "\" method=\"post\" enctype=\"multipart/form-data\" "
                               "namelist=\"r\"/></block>"),
                          "record 1s\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("got all"), std::string::npos) << lines.back();
}

TEST_F(AgentTest, OnlyWhatWasRecordedCanBeSentAsARecording) {
  std::ofstream(folder_ / "secret") << "a secret";
  HttpServer server([](const HttpServer::Request& request) {
    const bool leaked = request.body.find("secret") != std::string::npos;
    return Answer(Form(leaked ? "<block><exit expr=\"'leaked'\"/></block>"
                              : "<block><exit expr=\"'kept'\"/></block>"));
  });
  const auto lines =
      Talk(Form("<block><var name=\"r\" expr=\"({uri: 'file://" + (folder_ / "s") +
                "ecret', duration: 1, type: 'audio/x-wav'})\"/><submit next=\"" + server.Url("/") +
                "\" method=\"post\" enctype=\"multipart/form-data\" namelist=\"r\"/></block>"),
           "silence\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("kept"), std::string::npos) << lines.back();
}

TEST_F(AgentTest, WithoutAKeyboardTheEarAloneCounts) {
  std::ofstream(folder_ / "d.vxml")
      << "<vxml version=\"2.1\"><form><field name=\"f\" type=\"boolean\"><prompt timeout=\"50ms\">"
         "Well?</prompt><noinput><exit expr=\"'nobody'\"/></noinput></field></form></vxml>";
  const std::string command =
      GALATEA_BIN_DIR "/task_manager d.vxml --transcript json --connect unix:" + (folder_ / "hub");
  for (const char* input : {" </dev/null", ""}) {
    support::Process dialogue({"/bin/sh", "-c", "exec " + command + input},
                              support::Process::Options{.cwd = folder_.path(), .env = {}});
    dialogue.CloseInput();
    const auto lines = dialogue.ReadAll();
    ASSERT_FALSE(lines.empty()) << dialogue.ErrorText();
    EXPECT_NE(lines.back().find("\"value\":\"nobody\""), std::string::npos)
        << input << ": " << lines.back();
    EXPECT_EQ(dialogue.Wait(), 0);
  }
}

TEST_F(AgentTest, AFileOfTypedLinesIsTakenLineByLineAsTheDialogueListens) {
  std::ofstream(folder_ / "d.vxml") << Form(
      "<field name=\"a\" type=\"boolean\"><prompt bargein=\"false\">One?</prompt></field>"
      "<field name=\"b\" type=\"digits\"><prompt bargein=\"false\">Two?</prompt></field>"
      "<field name=\"c\" type=\"boolean\"><prompt bargein=\"false\">Three?</prompt></field>"
      "<block><exit expr=\"a+' '+b+' '+c\"/></block>");
  std::ofstream(folder_ / "typed.txt") << "yes\n\n/dtmf 42#\n/nonsense\nno";
  support::Process dialogue({"/bin/sh", "-c",
                             std::string("exec " GALATEA_BIN_DIR "/task_manager '") +
                                 (folder_ / "d.vxml") + "' --transcript json --connect 'unix:" +
                                 (folder_ / "hub") + "' < '" + (folder_ / "typed.txt") + "'"});
  EXPECT_TRUE(dialogue.Expect("true 42 false")) << dialogue.Seen() << dialogue.ErrorText();
}

TEST_F(AgentTest, LinesTypedBeforeTheDialogueListensWaitForIt) {
  std::ofstream(folder_ / "d.vxml") << Form(
      "<field name=\"a\" type=\"boolean\"><prompt bargein=\"false\">One?</prompt></field>"
      "<field name=\"b\" type=\"digits\"><prompt>Two?</prompt></field>"
      "<field name=\"c\" type=\"boolean\"><prompt>Three?</prompt></field>"
      "<block><exit expr=\"a+' '+b+' '+c\"/></block>");
  support::Process dialogue({GALATEA_BIN_DIR "/task_manager", folder_ / "d.vxml", "--connect",
                             "unix:" + (folder_ / "hub"), "--transcript", "json"});
  dialogue.WriteLine("yes");
  dialogue.WriteLine("/dtmf 42#");
  dialogue.WriteLine("no");
  EXPECT_TRUE(dialogue.Expect("true 42 false")) << dialogue.Seen() << dialogue.ErrorText();
}

TEST_F(AgentTest, AScriptedDialogueIsToldOnTheHubsClock) {
  const auto lines =
      Talk(Form("<field name=\"f\" type=\"boolean\"><prompt>Do you <emotion type=\"HAPPY\">like"
                "</emotion> it?</prompt></field>"),
           "say yes\n");
  ASSERT_GE(lines.size(), 3U);
  const auto number = [](const std::string& line, const std::string& name) {
    const std::size_t at = line.find("\"" + name + "\":");
    return at == std::string::npos ? -1.0 : std::atof(line.c_str() + at + name.size() + 3);
  };
  const auto line_of = [&](const std::string& type) {
    const auto found = std::ranges::find_if(lines, [&](const std::string& line) {
      return line.find("\"type\":\"" + type + "\"") != std::string::npos;
    });
    return found == lines.end() ? std::string() : *found;
  };
  const std::string prompt = line_of("prompt"), result = line_of("result");
  EXPECT_NE(prompt.find("\"feelings\":[\"HAPPY\"]"), std::string::npos) << prompt;
  EXPECT_GT(number(prompt, "ms"), 300) << prompt;
  // The ear's stand-in answers half a second after the prompt, and speaks a quarter of a second.
  EXPECT_GE(number(result, "t"), number(prompt, "t") + number(prompt, "ms") + 500) << result;
  EXPECT_LE(number(result, "t"), number(prompt, "t") + number(prompt, "ms") + 3000) << result;
}

TEST_F(AgentTest, AKeyEndsARecordingInTheMiddle) {
  std::ofstream(folder_ / "d.vxml") << Form(
      "<record name=\"r\" beep=\"true\" maxtime=\"60s\"><prompt>Speak.</prompt><filled><exit "
      "expr=\"r$.termchar+' '+r$.maxtime+' '+(r$.duration&lt;60000)\"/></filled></record>");
  // Time stands still for who speaks a minute for each word: only the key can be the end.
  std::ofstream(folder_ / "real.json")
      << "{\"listen\": [{\"role\": \"owner\", \"at\": \"unix:" << folder_ / "real"
      << "\"}], \"modules\": [{\"name\": \"SSM\", "
      << "\"command\": [\"" GALATEA_BIN_DIR "/ssm_stub\"]}, {\"name\": \"SRM\", \"command\": [\""
      << GALATEA_BIN_DIR "/srm_stub\"]}]}";
  support::Process hub({GALATEA_BIN_DIR "/agent_manager", "--config", folder_ / "real.json"});
  hub.WriteLine("to @SRM set#w Input.wordtime = 60000");
  ASSERT_TRUE(hub.Expect("Input.wordtime = 60000"));
  support::Process dialogue({GALATEA_BIN_DIR "/task_manager", folder_ / "d.vxml", "--connect",
                             "unix:" + (folder_ / "real"), "--transcript", "json"});
  ASSERT_TRUE(hub.Expect("tell end ")) << "the beep is over";
  dialogue.WriteLine("hello there");
  dialogue.WriteLine("/dtmf 7");
  EXPECT_TRUE(dialogue.Expect("7 false true")) << dialogue.Seen() << dialogue.ErrorText();
}

TEST_F(AgentTest, DialoguesOnOneHubWaitEachItsOwnTime) {
  const auto write = [&](const std::string& name, const std::string& timeout) {
    std::ofstream(folder_ / name) << Form("<field name=\"f\" type=\"boolean\"><prompt timeout=\"" +
                                          timeout +
                                          "\"><break time=\"1ms\"/></prompt><noinput><exit "
                                          "expr=\"'nobody'\"/></noinput></field>");
  };
  write("long.vxml", "3600s");
  write("short.vxml", "300ms");
  std::ofstream(folder_ / "s.txt") << "silence\n";
  std::ofstream(folder_ / "real.json")
      << "{\"listen\": [{\"role\": \"owner\", \"at\": \"unix:" << folder_ / "real"
      << "\"}], \"modules\": [{\"name\": \"SSM\", "
      << "\"command\": [\"" GALATEA_BIN_DIR "/ssm_stub\"]}, {\"name\": \"SRM\", \"command\": [\""
      << GALATEA_BIN_DIR "/srm_stub\"]}]}";
  support::Process hub({GALATEA_BIN_DIR "/agent_manager", "--config", folder_ / "real.json",
                        "--log", folder_ / "real.log"});
  hub.WriteLine("inq#up Slots");
  ASSERT_TRUE(hub.Expect("#up Slots"));
  const auto talk = [&](const std::string& document, const std::string& name) {
    return support::Process({GALATEA_BIN_DIR "/task_manager", folder_ / document, "--connect",
                             "unix:" + (folder_ / "real"), "--name", name, "--script",
                             folder_ / "s.txt"});
  };
  const auto log = [&] {
    std::ifstream file(folder_ / "real.log");
    return std::string{std::istreambuf_iterator<char>(file), {}};
  };
  support::Process first = talk("long.vxml", "DM");
  for (bool waits = false; !waits;) {
    hub.WriteLine("to @AM-MCL inq#m Macros");
    ASSERT_TRUE(hub.Expect("rep#m Macros")) << hub.Seen();
    waits = hub.Seen().find("DialoguePause.DM") != std::string::npos;
  }
  support::Process second = talk("short.vxml", "DM2");
  const auto lines = second.ReadAll();
  ASSERT_FALSE(lines.empty()) << second.ErrorText();
  EXPECT_NE(lines.back().find("nobody"), std::string::npos) << lines.back();
  EXPECT_EQ(second.Wait(), 0);
  hub.Terminate();
  hub.Wait();
  const auto time_of = [text = log()](const std::string& line) {
    const std::size_t at = text.find(line);
    if (at == std::string::npos) return -1;
    return std::atoi(text.c_str() + text.rfind('\n', at) + 1);
  };
  const int begins = time_of("DialoguePause.DM2 = NOW");
  const int ends = time_of("del DialoguePause.DM2");
  ASSERT_GE(begins, 0);
  EXPECT_GE(ends - begins, 300);
}

}  // namespace
}  // namespace vxml_test
