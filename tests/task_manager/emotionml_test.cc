#include "task_manager/document/emotionml.h"

#include <gtest/gtest.h>

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
        Sample{"TextInRoot", "hello", false}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace vxml_test
