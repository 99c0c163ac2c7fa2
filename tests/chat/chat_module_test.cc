#include "chat/core/chat_module.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/chat/chat_world.h"
#include "vm_protocol/core/limits.h"

namespace chat_test {
namespace {

using Lines = std::vector<std::string>;
using nlohmann::json;

TEST(ChatModuleTest, ItMeetsTheHubAndStartsTheEar) {
  ChatWorld world;
  EXPECT_EQ(world.lines.at(0), "0 to @AM set#c1 Subscribe = SRM SSM");
  EXPECT_EQ(world.Lines("to @SRM"),
            (Lines{"0 to @SRM set Grammar = NONE", "0 to @SRM inq#c3 Slots",
                   "0 to @SRM set Run = START", "0 to @SRM set Listen.complete = 250"}));
  EXPECT_EQ(world.Lines("Gaze"), Lines{"0 to @FSM set Gaze = USER"});
}

TEST(ChatModuleTest, TheEarHurriesOnlyWhileItListensForAConversation) {
  ChatWorld world;
  const auto last = [&world] { return world.Lines("Listen.complete").back(); };
  world.Tell("set Listen.pause = 300");
  EXPECT_TRUE(last().ends_with("= 300"));
  world.Tell("set Listen = OFF");
  EXPECT_TRUE(last().ends_with("= 0"));
  world.Tell("set#t Talk = 2 0");
  EXPECT_TRUE(last().ends_with("= 300"));
  world.Tell("set Talk = STOP");
  EXPECT_TRUE(last().ends_with("= 0"));
}

TEST(ChatModuleTest, WithoutAHubItAnswersInWords) {
  ChatWorld world({}, false);
  world.Tell("set#1 Input.text = Hello!");
  world.UntilIdle();
  EXPECT_EQ(world.lines.back(), "1000 rep#1 Input.text = Hello! I am Galatea. How are you today?");
  EXPECT_TRUE(world.Lines("Speak").empty());
}

TEST(ChatModuleTest, RulesAnswerSentenceBySentenceToTheMillisecond) {
  ChatWorld world;
  world.Until(100);
  world.Ear("Result = Hello!");
  world.UntilIdle();
  // "Hello!" lasts 6 x 50 ms, after 60 ms of preparation.
  EXPECT_EQ(world.Lines("Speak ="), (Lines{"100 to @AM-MCL set#c4 Speak = Hello!",
                                           "460 to @AM-MCL set#c5 Speak = I am Galatea.",
                                           "1170 to @AM-MCL set#c6 Speak = How are you today?"}));
  EXPECT_EQ(world.Lines("Text.next"), (Lines{"160 to @SSM set Text.next = I am Galatea.",
                                             "520 to @SSM set Text.next = How are you today?"}));
  EXPECT_EQ(world.Lines("Emotion"), Lines{"100 to @AM-MCL set Emotion = HAPPY 90"});
  EXPECT_EQ(world.Lines("Reply.times"), Lines{"160 rep Reply.times = words=0 sentence=0 sound=60"});
  EXPECT_EQ(world.Value("Reply"), "Hello! I am Galatea. How are you today?");
  EXPECT_FALSE(world.module->Busy());
  EXPECT_TRUE(world.net.calls.empty()) << "nothing is sent anywhere";
}

TEST(ChatModuleTest, AModelsWordsAreSpokenWhileTheRestStillComes) {
  ChatWorld world(Stub());
  world.Tell("set#1 Input.text = Hi");
  ASSERT_EQ(world.net.calls.size(), 1u);
  const json body = json::parse(world.net.last().request.body);
  EXPECT_EQ(body["model"], "stub");
  EXPECT_EQ(body["stream"], true);
  EXPECT_EQ(body["messages"], json::parse(R"([{"role":"system","content":"You are Galatea."},
                                              {"role":"user","content":"Hi"}])"));
  EXPECT_FALSE(body.contains("tools"));
  EXPECT_EQ(world.net.last().request.headers.back(), "Authorization: Bearer sk-1");
  world.net.Head(200);
  world.Until(200);
  world.net.Words("[ha");
  world.net.Words("ppy]Hello th");
  world.Until(300);
  world.net.Words("ere. [nod]My na");
  world.clock.RunReady();
  EXPECT_EQ(world.Lines("Speak ="), Lines{"300 to @AM-MCL set#c4 Speak = Hello there."});
  world.Until(400);
  world.net.Words("me is G.");
  world.net.Done();
  world.UntilIdle();
  EXPECT_EQ(world.Lines("Text.next"), Lines{"400 to @SSM set Text.next = My name is G."});
  EXPECT_EQ(world.Lines("FaceMot"), Lines{"960 to @FSM set FaceMot = NOD 1"});
  EXPECT_EQ(world.Lines("rep Reply.times"),
            Lines{"360 rep Reply.times = words=200 sentence=300 sound=360"});
  EXPECT_EQ(world.Lines("rep#1"), Lines{"1670 rep#1 Input.text = Hello there. My name is G."});
}

TEST(ChatModuleTest, ASentenceIsNotHeldBackWhenTheModelStallsBehindIt) {
  ChatWorld world(Stub());
  world.Tell("set Input.text = Hi");
  world.net.Head(200);
  world.net.Words("Hello.");
  world.Until(149);
  EXPECT_TRUE(world.Lines("Speak =").empty());
  world.Until(150);
  EXPECT_EQ(world.Lines("Speak ="), Lines{"150 to @AM-MCL set#c4 Speak = Hello."});
}

TEST(ChatModuleTest, TagsWithinASentenceHappenWhereTheVoicePassesThem) {
  ChatWorld world;
  world.Tell("set Say = Good [nod] day.");
  world.UntilIdle();
  EXPECT_EQ(world.Lines("Speak ="),
            Lines{"0 to @AM-MCL set#c4 Speak = Good <BOOKMARK MARK=\"chat1x0\"/>day."});
  EXPECT_EQ(world.Lines("FaceMot"), Lines{"310 to @FSM set FaceMot = NOD 1"});
}

TEST(ChatModuleTest, WhoSpeaksStopsVoiceAndRequestAndOnlyWhatWasHeardIsKept) {
  ChatWorld world(Stub());
  world.Ear("Result = Tell me a lot");
  world.net.Head(200);
  world.net.Words("One two three four. And five six. ");
  world.Until(620);
  world.Ear("Listen.stat = SPEECH");
  EXPECT_FALSE(world.net.last().open) << "the request is ended at once";
  EXPECT_EQ(world.Lines("= STOP"), Lines{"620 to @AM-MCL set Speak = STOP"});
  EXPECT_EQ(world.Value("Reply"), "One two");
  EXPECT_EQ(world.Value("Busy"), "IDLE");
  world.Ear("Result = Enough!");
  const json body = json::parse(world.net.last().request.body);
  EXPECT_EQ(body["messages"].back()["content"], "Enough!");
  EXPECT_EQ(body["messages"][2], json::parse(R"({"role":"assistant","content":"One two"})"));
  EXPECT_TRUE(world.errors.empty()) << world.errors.front();
}

TEST(ChatModuleTest, WhatIsSaidBeforeTheFirstSoundJoinsTheQuestion) {
  ChatWorld world(Stub());
  world.Ear("Result = One");
  world.Until(50);
  world.Ear("Result = two");
  world.UntilIdle();
  ASSERT_EQ(world.net.calls.size(), 2u);
  EXPECT_EQ(json::parse(world.net.last().request.body)["messages"].back()["content"], "One\ntwo");
}

TEST(ChatModuleTest, WithBargeInOffItIsDeafWhileItSpeaks) {
  ChatWorld world;
  world.Tell("set BargeIn = OFF");
  world.Ear("Result = Hello!");
  world.Until(100);
  world.Ear("Listen.stat = SPEECH");
  world.Ear("Result = Hello I am Galatea");
  world.UntilIdle();
  EXPECT_EQ(world.Value("Heard"), "Hello!");
  EXPECT_EQ(world.Value("Reply"), "Hello! I am Galatea. How are you today?");
}

TEST(ChatModuleTest, SayStopIsSilence) {
  ChatWorld world;
  world.Tell("set#1 Input.text = Hello!");
  world.Until(1000);
  world.Tell("set#2 Say = STOP");
  world.UntilIdle();
  EXPECT_EQ(world.Lines("rep#1"),
            Lines{"1000 rep#1 Input.text.error = STOPPED stopped after: Hello! I am"});
  EXPECT_EQ(world.Lines("rep#2").size(), 1u);
}

TEST(ChatModuleTest, ErrorsAreToldOnceApologisedForAndForgotten) {
  struct Case {
    int status;
    const char* apology;
    const char* error;
  };
  for (const Case& one :
       {Case{401, "I am sorry, I am not allowed to think just now.", "ACCESS"},
        Case{500, "I am sorry, I cannot reach my thoughts just now.", "UNAVAILABLE"},
        Case{429, "I am sorry, too many people ask me at once.", "BUSY"}}) {
    ChatWorld world(Stub());
    world.Ear("Result = Hi");
    world.net.Head(one.status, {});
    world.net.Data("{\"error\":{\"message\":\"sk-1 is bad\"}}");
    world.net.End();
    world.UntilIdle();
    EXPECT_TRUE(world.Lines("Speak =").at(0).contains(one.apology)) << world.Lines("Speak =").at(0);
    ASSERT_EQ(world.errors.size(), 1u);
    EXPECT_TRUE(world.errors[0].starts_with(one.error)) << world.errors[0];
    EXPECT_FALSE(world.errors[0].contains("sk-1"));
    EXPECT_EQ(world.History(), "[]");
  }
}

TEST(ChatModuleTest, AnAnswerWithoutAWordIsAnErrorButNotOneThatDidSomething) {
  ChatWorld world(Stub({"@FSM Mask"}));
  // As llama.cpp sends it for a model that has thought until its tokens were used up.
  const auto tell = [&](const json& delta, const json& reason) {
    world.net.Data(
        "data: " + json{{"choices", {{{"delta", delta}, {"finish_reason", reason}}}}}.dump() +
        "\n\n");
  };
  world.Tell("set#1 Input.text = Hi");
  world.net.Head(200);
  tell({{"role", "assistant"}, {"content", nullptr}}, nullptr);
  tell({{"reasoning_content", "Well"}}, nullptr);
  tell({{"content", "\n\n"}}, nullptr);
  tell(json::object(), "length");
  world.net.Done();
  world.UntilIdle();
  EXPECT_TRUE(world.Lines("Speak =").at(0).contains("I have lost my thread"));
  EXPECT_TRUE(world.Lines("rep#1").at(0).contains("Model.tokens")) << world.Lines("rep#1").at(0);
  EXPECT_EQ(world.History(), "[]");

  world.Tell("set#2 Input.text = Be somebody else");
  world.net.Head(200);
  tell({{"tool_calls",
         {{{"index", 0},
           {"id", "a"},
           {"function",
            {{"name", "set_slot"},
             {"arguments", R"({"slot": "@FSM Mask", "value": "pygmalion"})"}}}}}}},
       "tool_calls");
  world.net.Done();
  world.clock.RunReady();
  world.net.Head(200);
  tell(json::object(), "stop");
  world.net.Done();
  world.UntilIdle();
  EXPECT_EQ(world.Lines("Mask =").size(), 1u);
  EXPECT_EQ(world.Lines("Speak =").size(), 2u) << "the first apology's sentences, no second one";
}

TEST(ChatModuleTest, NothingIsSentBeforeTheEndpointWantsIt) {
  ChatWorld world(Stub());
  world.Tell("set Apology = OFF");
  world.Tell("set#1 Input.text = Hi");
  world.net.Head(429, {{"retry-after", "30"}});
  world.net.End();
  world.UntilIdle();
  world.Tell("set#2 Input.text = Hi");
  world.UntilIdle();
  EXPECT_EQ(world.net.calls.size(), 1u);
  EXPECT_TRUE(world.Lines("rep#2").at(0).contains("BUSY")) << world.Lines("rep#2").at(0);
  EXPECT_TRUE(world.Lines("Speak =").empty());
  world.Until(30'001);
  world.Tell("set#3 Input.text = Hi");
  ASSERT_EQ(world.net.calls.size(), 2u);
  EXPECT_TRUE(world.net.last().request.body.contains(R"({"content":"Hi","role":"user"})"))
      << "what nobody has answered is asked again: " << world.net.last().request.body;
}

TEST(ChatModuleTest, WhatCameBeforeAnErrorIsSpokenAndKept) {
  ChatWorld world(Stub());
  world.Tell("set#1 Input.text = Hi");
  world.net.Head(200);
  world.net.Words("One is here. Two bro");
  world.net.End();
  world.UntilIdle();
  EXPECT_EQ(world.Value("Reply"), "One is here. Two bro");
  EXPECT_TRUE(world.Lines("Speak =").at(2).contains("I have lost my thread"));
  EXPECT_TRUE(world.Lines("rep#1").at(0).contains("UNAVAILABLE"));
}

TEST(ChatModuleTest, AllowedSlotsAreSetAndOthersRefused) {
  ChatWorld world(Stub({"@FSM Mask", "@LAMP Lamp"}));
  world.Tell("set#1 Input.text = Be somebody else");
  json body = json::parse(world.net.last().request.body);
  EXPECT_EQ(body["tools"][0]["function"]["parameters"]["properties"]["slot"]["enum"],
            json::parse(R"(["@FSM Mask", "@LAMP Lamp"])"));
  world.net.Head(200);
  const auto call = [&](const std::string& id, const std::string& slot, const std::string& value,
                        int index) {
    const json arguments{{"slot", slot}, {"value", value}};
    const json piece{{"index", index},
                     {"id", id},
                     {"function", {{"name", "set_slot"}, {"arguments", arguments.dump()}}}};
    world.net.Data("data: " + json{{"choices", {{{"delta", {{"tool_calls", {piece}}}}}}}}.dump() +
                   "\n\n");
  };
  call("a", "@FSM Mask", "pygmalion", 0);
  call("b", "@AM Run", "EXIT", 1);
  call("c", "@FSM Mask", "x\nto @AM set Run = EXIT", 2);
  call("d", "@LAMP Lamp", "BLUE", 3);
  world.net.Done();
  world.clock.RunReady();
  EXPECT_EQ(world.Lines("Mask =").size(), 1u);
  EXPECT_TRUE(world.Lines("@AM set Run").empty());
  ASSERT_EQ(world.net.calls.size(), 2u);
  body = json::parse(world.net.last().request.body);
  const json& messages = body["messages"];
  ASSERT_EQ(messages.size(), 7u);
  EXPECT_EQ(messages[2]["tool_calls"].size(), 4u);
  EXPECT_EQ(messages[3]["content"], "ok: pygmalion");
  EXPECT_EQ(messages[4]["content"], "error: this slot may not be set");
  EXPECT_TRUE(std::string(messages[5]["content"]).starts_with("error: the value"));
  EXPECT_TRUE(std::string(messages[6]["content"]).starts_with("error: BAD_VALUE no such light"));
  world.net.Head(200);
  world.net.Words("Done.");
  world.net.Done();
  world.UntilIdle();
  EXPECT_EQ(world.Value("Reply"), "Done.");
}

TEST(ChatModuleTest, RoundsOfToolsAreBounded) {
  ChatWorld world(Stub({"@FSM Mask"}));
  world.Tell("set Tools.rounds = 2");
  world.Tell("set#1 Input.text = Go");
  for (int i = 0; i < 10 && world.net.last().open; ++i) {
    EXPECT_EQ(json::parse(world.net.last().request.body).contains("tools"), i < 2);
    world.net.Head(200);
    world.net.Data(
        "data: {\"choices\":[{\"delta\":{\"tool_calls\":[{\"index\":0,\"function\":"
        "{\"name\":\"x\",\"arguments\":\"\"}}]}}]}\n\ndata: [DONE]\n\n");
    world.clock.RunReady();
  }
  EXPECT_EQ(world.net.calls.size(), 3u);
  world.UntilIdle();
  EXPECT_TRUE(world.Lines("rep#1").at(0).contains("LIMIT"));
}

TEST(ChatModuleTest, WithoutAVoiceTheWordsAreStillThere) {
  ChatWorld world;
  world.voice_is_there = false;
  world.Tell("set#1 Input.text = Hello!");
  world.UntilIdle();
  EXPECT_EQ(world.Lines("rep#1"),
            Lines{"0 rep#1 Input.text = Hello! I am Galatea. How are you today?"});
  EXPECT_EQ(world.errors.size(), 1u) << "told once a reply, not once a sentence";
}

TEST(ChatModuleTest, HostileWordsBecomeNoCommands) {
  ChatWorld world;
  for (const char* const text : {"STOP", "stop", "<audio src=\"/etc/passwd\"/>x.", "${value} $1.",
                                 "<speak>x.</speak>", "&lt;speak&gt;."}) {
    world.Tell(std::string("set Say = [] ") + text);
    world.UntilIdle();
  }
  for (const std::string& line : world.Lines("Speak =")) {
    EXPECT_FALSE(line.contains('<')) << line;
    EXPECT_FALSE(line.ends_with("= STOP") || line.ends_with("= stop")) << line;
  }
}

TEST(ChatModuleTest, AConversationIsLentForSoManyTurns) {
  ChatWorld world;
  world.Tell("set Listen = OFF");
  world.Ear("Result = Not for me");
  EXPECT_TRUE(world.Lines("Heard").empty());
  world.Tell("set#t Talk = 2 5000");
  world.Ear("Result = Hello!");
  world.UntilIdle();
  EXPECT_EQ(world.Lines("rep#t"), Lines{"7030 rep#t Talk = SILENCE 1 Hello!"});
  world.Tell("set#u Talk = 2 0");
  world.Ear("Result = one");
  world.UntilIdle();
  world.Ear("Result = two");
  world.UntilIdle();
  ASSERT_EQ(world.Lines("rep#u").size(), 1u);
  EXPECT_TRUE(world.Lines("rep#u")[0].ends_with("Talk = TURNS 2 two"));
  world.Tell("set#v Talk = 9 0");
  world.Tell("set Talk = STOP");
  EXPECT_TRUE(world.Lines("rep#v").at(0).ends_with("Talk = STOPPED 0"));
}

TEST(ChatModuleTest, ALentConversationHasAGoalAndTheModelSaysWithWhichResultItEnds) {
  ChatWorld world(Stub());
  world.Tell("set Talk.goal = Find out where to go.");
  world.Tell("set#t Talk = 9 0");
  world.Ear("Result = To Kyoto");
  const json body = json::parse(world.net.last().request.body);
  EXPECT_EQ(body["messages"][0]["content"], "You are Galatea.\nFor this: Find out where to go.");
  world.net.Head(200);
  world.net.Words("Kyoto it is. [end kyoto]");
  world.net.Done();
  world.UntilIdle();
  ASSERT_EQ(world.Lines("to @CHAT set Talk = END kyoto").size(), 1u);
  world.Tell("set Talk = END kyoto");  // the hub brings it back
  EXPECT_TRUE(world.Lines("rep#t").at(0).ends_with("Talk = ENDED 1 To Kyoto"));
  EXPECT_EQ(world.Value("Talk.result"), "kyoto");
  EXPECT_EQ(world.Value("Talk.goal"), "");
  world.Tell("set#u Talk = 1 0");
  EXPECT_EQ(world.Value("Talk.result"), "") << "that of a conversation before";
  world.Ear("Result = Hi");
  EXPECT_EQ(json::parse(world.net.last().request.body)["messages"][0]["content"],
            "You are Galatea.");
}

TEST(ChatModuleTest, APhraseEndsALentConversationWithoutAnAnswer) {
  ChatWorld world;
  world.Tell("set Talk.end = that is all | back to the menu | もういい");
  world.Tell("set#t Talk = 9 0");
  world.Ear("Result = Is that all you know?");
  world.UntilIdle();
  EXPECT_TRUE(world.Lines("rep#t").empty());
  const std::size_t spoken = world.Lines("set#").size();
  world.Ear("Result = Well, THAT is - all. Thanks");
  world.UntilIdle();
  EXPECT_EQ(world.Lines("set#").size(), spoken) << "the borrower goes on";
  EXPECT_TRUE(world.Lines("rep#t").at(0).ends_with("ENDED 2 Well, THAT is - all. Thanks"));
  EXPECT_EQ(world.Value("Busy"), "IDLE");
}

TEST(EndPhrasesTest, WordsCountAndSignsDoNot) {
  const chat::EndPhrases phrases("stop it|もういい|  |!");
  EXPECT_TRUE(phrases.FoundIn("Please, stop it!"));
  EXPECT_TRUE(phrases.FoundIn("いや、もういいです"));
  EXPECT_FALSE(phrases.FoundIn("do not nonstop it"));
  EXPECT_FALSE(phrases.FoundIn("stop"));
  EXPECT_FALSE(phrases.FoundIn(""));
  EXPECT_FALSE(chat::EndPhrases("").FoundIn("anything"));
}

TEST(ChatModuleTest, AModelThatDoesNotAnswerEndsALentConversationAsAnError) {
  ChatWorld world(Stub());
  world.Tell("set#t Talk = 9 0");
  world.Ear("Result = Hello");
  world.net.Head(500);
  world.net.End();
  world.UntilIdle();
  EXPECT_TRUE(world.Lines("rep#t").at(0).contains("Talk.error = UNAVAILABLE"))
      << world.Lines("rep#t").at(0);
  world.Tell("set#u Talk = 9 0");
  EXPECT_TRUE(world.Lines("rep#u").empty()) << "it can be lent again";
}

TEST(ChatModuleTest, AConversationEndsWithWhoeverHasBorrowedIt) {
  ChatWorld world;
  world.modules = "SSM SRM DM CHAT";
  const auto ends = [&world] { return world.Lines("rep Talk.over"); };
  world.Tell("set Listen = OFF");
  world.Tell("set#t Talk = 9 0 DM");
  EXPECT_TRUE(world.Lines("rep#t").at(0).ends_with("Talk = LENT"));
  EXPECT_EQ(world.Lines("set Subscribe = SRM SSM AM").size(), 1u);
  world.Ear("Result = Hello!");
  world.Tell("From @AM tell @DM2 has gone: end of input");
  EXPECT_TRUE(ends().empty());
  world.Tell("From @AM tell @DM has gone: end of input");
  world.UntilIdle();
  EXPECT_TRUE(ends().at(0).ends_with("= STOPPED 1 Hello!"));
  EXPECT_TRUE(world.Lines("Subscribe").back().ends_with("set Subscribe = SRM SSM"));
  world.Tell("set#u Talk = 9 0 NOBODY");
  world.UntilIdle();
  EXPECT_TRUE(ends().at(1).ends_with("= STOPPED 0")) << "it had gone before";
  world.Tell("set#v Talk = 9 0 DM");
  world.UntilIdle();
  EXPECT_TRUE(world.Lines("rep#v").at(0).ends_with("= LENT")) << "it can be lent again";
  EXPECT_EQ(ends().size(), 2u);
  EXPECT_EQ(world.Lines("rep#t").size(), 1u) << "answered once";
}

TEST(ChatModuleTest, ALongReplyFitsIntoItsLines) {
  ChatWorld world(Stub());
  world.Tell("set Model.bytes = 65536");
  world.Tell("set Model.seconds = 600");
  world.Tell("set#1 Input.text = Hi");
  world.net.Head(200);
  for (int i = 0; i < 4000; ++i) world.net.Words("Quote \\\"x\\\" now. ");
  world.net.Done();
  world.UntilIdle();
  for (const std::string& line : world.lines) EXPECT_LT(line.size(), vm::kMaxLineBytes);
  EXPECT_LT(world.History().size(), vm::kMaxLineBytes - 100);
}

TEST(HistoryTest, OldTurnsAreForgottenFirst) {
  chat::History history;
  history.set_turns(2);
  for (int i = 0; i < 5; ++i) {
    history.AddUser("u" + std::to_string(i));
    history.AddAgent("a" + std::to_string(i));
  }
  ASSERT_EQ(history.entries().size(), 4u);
  EXPECT_EQ(history.entries()[0].text, "u3");
  history.AddUser(std::string(100'000, 'x'));
  EXPECT_LE(history.Json().size(), chat::History::kMaxBytes + 100);
}

}  // namespace
}  // namespace chat_test
