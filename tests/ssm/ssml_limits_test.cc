// What SSML asks for and does not get: languages without a voice, references that lead elsewhere,
// values beyond a limit. Each is told once.

#include <gtest/gtest.h>

#include "ssm/voice/lexicon.h"
#include "ssm/voice/markup_uri.h"
#include "ssm/voice/ssml.h"
#include "ssm_stub/rule_engine.h"
#include "tests/ssm/voice_world.h"

namespace {

using Strings = std::vector<std::string>;

const ssm::MarkupOptions kEnglishAndGerman{
    .speaks = [](const std::string& language) { return language == "en" || language == "de"; },
    .is_sound = [](const std::string&) { return true; }};

ssm::TaggedText Read(const std::string& inside, const std::string& attributes = "",
                     const ssm::MarkupOptions& options = kEnglishAndGerman) {
  auto read =
      ssm::ReadMarkup("<speak version='1.1' " + attributes + ">" + inside + "</speak>", options);
  EXPECT_TRUE(read) << inside << (read ? "" : read.error().text);
  return read ? std::move(*read) : ssm::TaggedText{};
}
Strings NotesOf(const std::string& inside, const std::string& attributes = "") {
  return Read(inside, attributes).notes;
}

const std::string kLeftOut = "SSML: no voice speaks 'tlh'; the text in it is left out";
const std::string kReadAll =
    "SSML: no voice speaks 'tlh'; the text in it is read as what is around it";

TEST(LangFailureTest, IgnoretextLeavesTheTextOutWhereverItStands) {
  for (const std::string name : {"lang", "s", "p", "voice", "token", "w"}) {
    const auto read = Read("a <" + name +
                           " xml:lang='tlh' onlangfailure='ignoretext'>b <sub alias='c'>d</sub>"
                           "<phoneme ph='e'>f</phoneme><say-as interpret-as='digits'>1</say-as></" +
                           name + "> g");
    EXPECT_EQ(read.plain, "a g") << name;
    EXPECT_EQ(read.notes, Strings{kLeftOut}) << name;
  }
  EXPECT_EQ(Read("a", "xml:lang='tlh' onlangfailure='ignoretext'").plain, "");
}

TEST(LangFailureTest, ItHoldsForWhatIsInsideUntilAnotherIsSaid) {
  const std::string root = "xml:lang='en' onlangfailure='ignoretext'";
  EXPECT_EQ(Read("a <lang xml:lang='tlh'>b</lang>", root).plain, "a ");
  EXPECT_EQ(Read("a <p onlangfailure='ignorelang'><lang xml:lang='tlh'>b</lang></p>", root).plain,
            "a b");
  const auto read = Read(
      "<lang xml:lang='tlh'>a <lang xml:lang='de-AT'>b</lang> c<mark name='m'/></lang> d", root);
  EXPECT_EQ(read.plain, "b d");
  ASSERT_EQ(read.spans.size(), 2u);
  EXPECT_EQ(read.spans[0].language, "de-AT");
  EXPECT_EQ(read.spans[1].mark, "m");
}

TEST(LangFailureTest, AllOthersReadTheTextInTheLanguageAroundIt) {
  for (const std::string how : {"", "onlangfailure='changevoice'", "onlangfailure='ignorelang'",
                                "onlangfailure='processorchoice'"}) {
    const auto read =
        Read("<lang xml:lang='de'>a <lang xml:lang='tlh' " + how + ">b</lang></lang>", "");
    EXPECT_EQ(read.plain, "a b") << how;
    EXPECT_EQ(read.spans.back().language, "de") << how;
    EXPECT_EQ(read.notes, Strings{kReadAll}) << how;
  }
  EXPECT_EQ(Read("a", "xml:lang='tlh'").notes, Strings{kReadAll});
}

TEST(LangFailureTest, ALanguageWithAVoiceFailsInNoWay) {
  const auto read = Read("<lang xml:lang='DE-de' onlangfailure='ignoretext'>a</lang>", "");
  EXPECT_EQ(read.plain, "a");
  EXPECT_TRUE(read.notes.empty());
  EXPECT_EQ(NotesOf("<lang xml:lang='de' onlangfailure='shout'>a</lang>"),
            Strings{"SSML: <lang onlangfailure=\"shout\"> is not understood"});
}

TEST(LangFailureTest, TheVoiceModuleTellsItOnce) {
  ssm_test::VoiceWorld world(ssm_stub::MakeRuleEngine());
  const std::string text =
      "set Text = <speak version='1.1'>hello <lang xml:lang='tlh' onlangfailure='ignoretext'>x"
      "</lang><lang xml:lang='ja'>あ</lang><lang xml:lang='tlh-x'>y</lang></speak>";
  world.Tell(text);
  EXPECT_EQ(world.Ask("Speak.text"), "hello あy");
  ASSERT_EQ(world.errors.size(), 2u);
  EXPECT_EQ(world.errors[0], "UNAVAILABLE " + kLeftOut);
  world.Tell(text);
  EXPECT_EQ(world.errors.size(), 2u);
}

TEST(LexiconLimitTest, WordsAndWhatIsSaidForThemHaveALength) {
  using ssm::Lexicon;
  const auto parse = [](std::size_t grapheme, std::size_t alias) {
    return Lexicon::Parse(
        "<lexicon version='1.0' xmlns='http://www.w3.org/2005/01/pronunciation-lexicon' "
        "alphabet='ipa' xml:lang='en'><lexeme><grapheme>" +
            std::string(grapheme, 'a') + "</grapheme><alias>" + std::string(alias, 'b') +
            "</alias></lexeme></lexicon>",
        "l.pls");
  };
  EXPECT_TRUE(parse(Lexicon::kMaxGrapheme, Lexicon::kMaxSaid));
  for (const auto& refused :
       {parse(Lexicon::kMaxGrapheme + 1, 1), parse(1, Lexicon::kMaxSaid + 1)}) {
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, vm::Errc::kLimit);
    EXPECT_TRUE(refused.error().text.starts_with("l.pls:1: ")) << refused.error().text;
  }
}

TEST(MarkupUriTest, ReferencesAreResolvedAgainstTheBase) {
  using ssm::ResolveUri;
  EXPECT_EQ(ResolveUri("", "a.wav"), "a.wav");
  EXPECT_EQ(ResolveUri("sub/", "a.wav"), "sub/a.wav");
  EXPECT_EQ(ResolveUri("sub/doc.ssml", "a.wav"), "sub/a.wav");
  EXPECT_EQ(ResolveUri("doc.ssml", "a.wav"), "a.wav");
  EXPECT_EQ(ResolveUri("/x/y/", "../a.wav"), "/x/y/../a.wav");
  EXPECT_EQ(ResolveUri("/x/y/", "/a.wav"), "/a.wav");
  EXPECT_EQ(ResolveUri("file:///x/y.ssml", "a.wav"), "file:///x/a.wav");
  EXPECT_EQ(ResolveUri("http://h/x/y", "/a.wav"), "http://h/a.wav");
  EXPECT_EQ(ResolveUri("http://h", "a.wav"), "http://h/a.wav");
  EXPECT_EQ(ResolveUri("http://h/x", "//g/a.wav"), "http://g/a.wav");
  EXPECT_EQ(ResolveUri("sub/", "file:///a.wav"), "file:///a.wav");
  EXPECT_EQ(ssm::FilePathOf("file:///x/a.wav"), "/x/a.wav");
  EXPECT_EQ(ssm::FilePathOf("file://localhost/x/a.wav"), "/x/a.wav");
  EXPECT_EQ(ssm::FilePathOf("file:/x/a.wav"), "/x/a.wav");
  EXPECT_EQ(ssm::FilePathOf("x/a.wav"), "x/a.wav");
}

TEST(MarkupUriTest, XmlBaseHoldsForSoundsAndLexicons) {
  EXPECT_EQ(Read("<audio src='a.wav'/>", "xml:base='sub/'").spans[0].audio, "sub/a.wav");
  EXPECT_EQ(Read("<p xml:base='deep/'><audio src='a.wav'/></p>", "xml:base='sub/'").spans[0].audio,
            "sub/deep/a.wav");
  EXPECT_EQ(Read("<audio xml:base='file:///x/' src='a.wav'/>").spans[0].audio, "/x/a.wav");
  EXPECT_EQ(Read("<p xml:base='deep/'>a</p><audio src='a.wav'/>").spans.back().audio, "a.wav");
  std::string asked;
  const ssm::MarkupOptions options{.read_file = [&](const std::string& path) {
    asked = path;
    return vm::Result<std::string>("<lexicon version='1.0'/>");
  }};
  Read("<lexicon uri='l.pls' xml:id='l'/>a", "xml:base='sub/'", options);
  EXPECT_EQ(asked, "sub/l.pls");
}

TEST(SsmlLimitsTest, AnUnknownAlphabetIsToldAndTheTextIsRead) {
  const auto read = Read("<phoneme alphabet='foo' ph='zz'>cat</phoneme>");
  ASSERT_EQ(read.spans.size(), 1u);
  EXPECT_EQ(read.spans[0].text, "cat");
  EXPECT_EQ(read.notes, Strings{"SSML: <phoneme alphabet=\"foo\"> is not understood"});
  EXPECT_TRUE(NotesOf("<phoneme alphabet='ipa' ph='kæt'>cat</phoneme>").empty());
}

TEST(SsmlLimitsTest, MessagesNameWhatIsWrong) {
  EXPECT_EQ(NotesOf("<lookup ref='nope'>a</lookup>"),
            Strings{"SSML: <lookup ref=\"nope\">: there is no <lexicon> of that xml:id"});
  EXPECT_EQ(NotesOf("<say-as interpret-as='cardinal'>1234567890123456</say-as>"),
            Strings{"SSML: <say-as interpret-as=\"cardinal\">: '1234567890123456' is read as it is "
                    "written, expected a whole number of at most 15 digits"});
  EXPECT_EQ(NotesOf("<say-as interpret-as='date' format='ymd'>soon</say-as>"),
            Strings{"SSML: <say-as interpret-as=\"date\" format=\"ymd\">: 'soon' is read as it is "
                    "written, expected the figures its format names, with / - or . between"});
  EXPECT_EQ(NotesOf("a<mark/>b<mark name=''/>"),
            Strings{"SSML: <mark> without a name is left out"});
}

struct Limit {
  const char *markup, *note;
};
constexpr Limit kLimits[] = {
    {"<prosody duration='500s'>a</prosody>", "prosody duration=\"500s\"> is beyond the limit, 60s"},
    {"<prosody rate='0%'>a</prosody>", "prosody rate=\"0%\"> is beyond the limit, 20%"},
    {"<prosody rate='99'>a</prosody>", "prosody rate=\"99\"> is beyond the limit, 500%"},
    {"<prosody pitch='9000Hz'>a</prosody>", "prosody pitch=\"9000Hz\"> is beyond the limit, 800Hz"},
    {"<prosody pitch='+30st'>a</prosody>", "prosody pitch=\"+30st\"> is beyond the limit, 200%"},
    {"<prosody volume='+60dB'>a</prosody>", "prosody volume=\"+60dB\"> is beyond the limit, 400%"},
    {"<prosody range='+900%'>a</prosody>", "prosody range=\"+900%\"> is beyond the limit, 400%"},
    {"<break time='100000s'/>", "break time=\"100000s\"> is beyond the limit, 60s"},
    {"<break time='-1s'/>", "break time=\"-1s\"> is beyond the limit, 0s"},
    {"<audio src='a' speed='0%'/>", "audio speed=\"0%\"> is beyond the limit, 25%"},
    {"<audio src='a' soundLevel='+60dB'/>",
     "audio soundLevel=\"+60dB\"> is beyond the limit, 400%"},
    {"<audio src='a' repeatCount='1e9'/>", "audio repeatCount=\"1e9\"> is beyond the limit, 1000"},
    {"<audio src='a' repeatDur='9999s'/>", "audio repeatDur=\"9999s\"> is beyond the limit, 600s"},
    {"<audio src='a' clipBegin='9999s'/>", "audio clipBegin=\"9999s\"> is beyond the limit, 600s"},
};

TEST(SsmlLimitsTest, ValuesBeyondALimitAreToldOnce) {
  for (const Limit& limit : kLimits) {
    EXPECT_EQ(NotesOf(std::string(limit.markup) + "a" + limit.markup),
              Strings{"SSML: <" + std::string(limit.note) + " is taken"})
        << limit.markup;
  }
  EXPECT_EQ(NotesOf("<break time='50s'/><break time='50s'/>"),
            Strings{"pauses in a row are cut to 60 s"});
  EXPECT_TRUE(NotesOf("<prosody duration='60s' rate='20%' pitch='50%'>a</prosody>"
                      "<audio src='a' clipBegin='90s' repeatCount='1000' speed='400%'/>")
                  .empty());
  EXPECT_EQ(NotesOf("<audio src='a' repeatCount='often' clipEnd='late' speed='quick'/>").size(),
            3u);
}

}  // namespace
