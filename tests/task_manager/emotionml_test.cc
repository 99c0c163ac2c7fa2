#include "task_manager/document/emotionml.h"

#include <gtest/gtest.h>

#include "task_manager/document/emotion_vocabularies.h"
#include "task_manager/document/schema.h"
#include "task_manager/interpreter/feelings.h"
#include "vm_protocol/xml/parser.h"

namespace vxml_test {
namespace {

struct Sample {
  const char* name;
  const char* text;  ///< children of <emotionml>
  bool good;
};

class EmotionMl : public ::testing::TestWithParam<Sample> {};

TEST_P(EmotionMl, IsJudgedByItsRules) {
  const std::string text =
      std::string(
          "<emotionml version=\"1.0\" xmlns=\"http://www.w3.org/2009/10/emotionml\" "
          "category-set=\"http://www.w3.org/TR/emotion-voc/xml#big6\" "
          "dimension-set=\"http://www.w3.org/TR/emotion-voc/xml#pad-dimensions\">") +
      GetParam().text + "</emotionml>";
  auto parsed = vm::xml::Parse(text, "e");
  ASSERT_TRUE(parsed) << parsed.error().text;
  ASSERT_TRUE(vxml::IsEmotionMl(*parsed->root));
  const auto findings = vxml::CheckEmotionMl(*parsed->root);
  EXPECT_EQ(findings.empty(), GetParam().good)
      << (findings.empty() ? "nothing found" : vxml::FormatFinding("e", findings[0]));
}

INSTANTIATE_TEST_SUITE_P(
    Samples, EmotionMl,
    ::testing::Values(
        Sample{"Empty", "", true},
        Sample{"Category", "<emotion><category name=\"anger\"/></emotion>", true},
        Sample{"ValueAndConfidence",
               "<emotion><category name=\"anger\" value=\"0.3\" confidence=\"1\"/></emotion>",
               true},
        Sample{"Dimensions",
               "<emotion><dimension name=\"arousal\" value=\"0\"/><dimension name=\"pleasure\" "
               "value=\"1.0\"/></emotion>",
               true},
        Sample{"Trace",
               "<emotion><dimension name=\"arousal\"><trace freq=\"10Hz\" samples=\"0.1 0.5 "
               "1\"/></dimension></emotion>",
               true},
        Sample{"Reference",
               "<emotion><category name=\"fear\"/><reference uri=\"a.wav#t=1,2\" "
               "role=\"triggeredBy\"/></emotion>",
               true},
        Sample{"Times",
               "<emotion start=\"1268647200\" duration=\"130\" expressed-through=\"face "
               "voice\"><category name=\"fear\"/></emotion>",
               true},
        Sample{"OwnVocabulary",
               "<vocabulary type=\"category\" id=\"v\"><item name=\"x\"/></vocabulary><emotion "
               "category-set=\"#v\"><category name=\"x\"/></emotion>",
               true},
        Sample{"TextInEmotion", "<emotion><category name=\"fear\"/>Oh no!</emotion>", true},
        Sample{"Info",
               "<info><any xmlns=\"urn:x\">a</any></info><emotion><info/><category "
               "name=\"fear\"/></emotion>",
               true},
        Sample{"NothingDescribed", "<emotion/>", false},
        Sample{"UnknownName", "<emotion><category name=\"hunger\"/></emotion>", false},
        Sample{"NoSet", "<emotion><appraisal name=\"novelty\"/></emotion>", false},
        Sample{"ValueTooLarge", "<emotion><category name=\"fear\" value=\"1.1\"/></emotion>",
               false},
        Sample{"ValueNoNumber", "<emotion><category name=\"fear\" value=\"big\"/></emotion>",
               false},
        Sample{"ConfidenceNegative",
               "<emotion><category name=\"fear\" confidence=\"-0.1\"/></emotion>", false},
        Sample{"DimensionWithoutValue", "<emotion><dimension name=\"arousal\"/></emotion>", false},
        Sample{"ValueAndTrace",
               "<emotion><dimension name=\"arousal\" value=\"1\"><trace freq=\"1Hz\" "
               "samples=\"1\"/></dimension></emotion>",
               false},
        Sample{"TraceWithoutFreq",
               "<emotion><dimension name=\"arousal\"><trace samples=\"1\"/></dimension></emotion>",
               false},
        Sample{"TraceSampleTooLarge",
               "<emotion><dimension name=\"arousal\"><trace freq=\"1Hz\" samples=\"0 "
               "2\"/></dimension></emotion>",
               false},
        Sample{"SameCategoryTwice",
               "<emotion><category name=\"fear\"/><category name=\"fear\"/></emotion>", false},
        Sample{
            "UnknownRole",
            "<emotion><category name=\"fear\"/><reference uri=\"a\" role=\"likedBy\"/></emotion>",
            false},
        Sample{"ReferenceWithoutUri", "<emotion><category name=\"fear\"/><reference/></emotion>",
               false},
        Sample{"NegativeDuration", "<emotion duration=\"-3\"><category name=\"fear\"/></emotion>",
               false},
        Sample{"EndBeforeStart",
               "<emotion start=\"5\" end=\"3\"><category name=\"fear\"/></emotion>", false},
        Sample{"WrongSetType",
               "<emotion "
               "category-set=\"http://www.w3.org/TR/emotion-voc/xml#pad-dimensions\"><category "
               "name=\"arousal\"/></emotion>",
               false},
        Sample{"UnknownOwnVocabulary",
               "<emotion category-set=\"#none\"><category name=\"x\"/></emotion>", false},
        Sample{"VocabularyWithoutId",
               "<vocabulary type=\"category\"><item name=\"x\"/></vocabulary>", false},
        Sample{"VocabularyItemTwice",
               "<vocabulary type=\"category\" id=\"v\"><item name=\"x\"/><item "
               "name=\"x\"/></vocabulary>",
               false},
        Sample{"UnknownElement", "<emotion><category name=\"fear\"/><mood/></emotion>", false},
        Sample{"UnknownAttribute", "<emotion mood=\"bad\"><category name=\"fear\"/></emotion>",
               false},
        Sample{"TextInRoot", "hello", true},
        Sample{"ForeignElement",
               "<emotion><category name=\"fear\"/><x:y xmlns:x=\"urn:x\"/></emotion>", false},
        Sample{"ForeignCategoryDescribesNothing",
               "<emotion><x:category xmlns:x=\"urn:x\" name=\"fear\"/></emotion>", false},
        Sample{"LateInfo", "<emotion><category name=\"fear\"/><info/></emotion>", false},
        Sample{"LateInfoOfRoot", "<emotion><category name=\"fear\"/></emotion><info/>", false},
        Sample{"InfoOfItsOwn", "<info><emotion><category name=\"fear\"/></emotion></info>", false},
        Sample{"InfoWithText", "<info>by <b xmlns=\"urn:x\">me</b></info>", true},
        Sample{"ItemWithInfo",
               "<vocabulary type=\"category\" id=\"v\"><info/><item name=\"x\"><info/></item>"
               "</vocabulary>",
               true},
        Sample{"ItemWithText",
               "<vocabulary type=\"category\" id=\"v\"><item name=\"x\">y</item></vocabulary>",
               false},
        Sample{"ItemWithElement",
               "<vocabulary type=\"category\" id=\"v\"><item name=\"x\"><item name=\"y\"/></item>"
               "</vocabulary>",
               false},
        Sample{"TextInVocabulary",
               "<vocabulary type=\"category\" id=\"v\">a<item name=\"x\"/></vocabulary>", false},
        Sample{"TraceWithContent",
               "<emotion><dimension name=\"arousal\"><trace freq=\"1Hz\" samples=\"1\">x</trace>"
               "</dimension></emotion>",
               false},
        Sample{"NameEmpty", "<vocabulary type=\"category\" id=\"v\"><item name=\"\"/></vocabulary>",
               false},
        Sample{"NameWithBlank",
               "<vocabulary type=\"category\" id=\"v\"><item name=\"a b\"/></vocabulary>", false},
        Sample{"UriBad", "<emotion><category name=\"fear\"/><reference uri=\";:\"/></emotion>",
               false},
        Sample{"UriEscaped",
               "<emotion><category name=\"fear\"/><reference uri=\"http://a/%zz\"/></emotion>",
               false},
        Sample{"UriOfSetBad", "<emotion category-set=\"a b#c\"><category name=\"x\"/></emotion>",
               false},
        Sample{"MediaTypeBad",
               "<emotion><category name=\"fear\"/><reference uri=\"a\" media-type=\"sound\"/>"
               "</emotion>",
               false},
        Sample{"ReferenceWithContent",
               "<emotion><category name=\"fear\"/><reference uri=\"a\">b</reference></emotion>",
               false},
        Sample{"SignedNumbers",
               "<emotion start=\"+5\" offset-to-start=\"-3\"><category name=\"fear\" value=\"+1\"/>"
               "</emotion>",
               true},
        Sample{"ExpressedThroughNothing",
               "<emotion expressed-through=\" \"><category name=\"fear\"/></emotion>", false}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(EmotionMlTest, AnEmotionAloneIsNoDocument) {
  auto parsed = vm::xml::Parse(
      "<emotion xmlns=\"http://www.w3.org/2009/10/emotionml\" category-set=\""
      "http://www.w3.org/TR/emotion-voc/xml#big6\"><category name=\"anger\"/></emotion>",
      "e");
  ASSERT_TRUE(parsed);
  ASSERT_TRUE(vxml::IsEmotionMl(*parsed->root));
  const auto findings = vxml::CheckEmotionMl(*parsed->root);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_NE(findings[0].advice.find("emotionml"), std::string::npos);
}

TEST(FeelingsTest, EveryNameOfTheStandardsVocabulariesIsShown) {
  int names = 0;
  for (const char* id :
       {"big6", "everyday-categories", "occ-categories", "fsre-categories", "frijda-categories",
        "occ-appraisals", "scherer-appraisals", "ema-appraisals", "frijda-action-tendencies"}) {
    const auto* vocabulary = vxml::FindEmotionVocabulary(id);
    ASSERT_NE(vocabulary, nullptr) << id;
    for (const auto name : vxml::SplitWords(vocabulary->names)) {
      ++names;
      EXPECT_NE(vxml::FindFeeling(vocabulary->type, std::string(name)), nullptr)
          << id << " " << name;
    }
  }
  EXPECT_GT(names, 120);
}

std::optional<vxml::Feeling> Felt(const std::string& emotion) {
  auto parsed = vm::xml::Parse(emotion, "e");
  EXPECT_TRUE(parsed) << emotion;
  return vxml::ReadFeeling(*parsed->root);
}

TEST(FeelingsTest, AnEmotionIsShownByItsTable) {
  EXPECT_EQ(Felt("<emotion type='disappointed'/>")->type, "SAD");
  EXPECT_EQ(Felt("<emotion><category name='shock' value='0.5'/></emotion>")->type, "SURPRISED");
  EXPECT_EQ(Felt("<emotion><category name='shock' value='0.5'/></emotion>")->strength, 50);
  EXPECT_EQ(Felt("<emotion><category name='worried'/></emotion>")->strength, 50);
  EXPECT_EQ(Felt("<emotion><action-tendency name='agonistic' value='1'/></emotion>")->type,
            "ANGRY");
  EXPECT_EQ(Felt("<emotion><dimension name='unpredictability' value='0.9'/></emotion>")->type,
            "SURPRISED");
  EXPECT_FALSE(Felt("<emotion><category name='hunger'/></emotion>"));
}

TEST(FeelingsTest, ATableWithAFaultIsRefusedWithItsLine) {
  EXPECT_EQ(vxml::ParseFeelings("# x\ncategory joy HAPPY\n", "t").error().text,
            "t:2: expected KIND NAME EXPRESSION STRENGTH");
  EXPECT_EQ(vxml::ParseFeelings("category joy GLAD 100", "t").error().text,
            "t:1: 'GLAD', expected one of HAPPY ANGRY DISGUSTED SAD SURPRISED FEARED NEUTRAL");
  EXPECT_FALSE(vxml::ParseFeelings("mood joy HAPPY 100", "t"));
  EXPECT_FALSE(vxml::ParseFeelings("category joy HAPPY 999", "t"));
}

}  // namespace
}  // namespace vxml_test
