// The hub's page in a browser: what people see, type and press.

#include "tests/agent_manager/web_support.h"

namespace {

using namespace web_support;

class WebPageTest : public WebTest {
 protected:
  void SetUp() override {
    if (Chromium() == nullptr)
      GTEST_SKIP() << "no chromium here (Debian package chromium-headless-shell or chromium)";
  }
  /// A browser that shows the page and takes these steps (tests/support/browse.py).
  std::unique_ptr<Process> Browse(std::vector<std::string> steps) {
    std::vector<std::string> command{"python3",
                                     GALATEA_SOURCE_DIR "/tests/support/browse.py",
                                     Chromium(),
                                     folder_ / "profile",
                                     Address() + "?token=" + kToken,
                                     "--autoplay-policy=no-user-gesture-required",
                                     "--lang=en",
                                     "wait:document.querySelector('#link.on')"};
    command.insert(command.end(), steps.begin(), steps.end());
    return std::make_unique<Process>(command);
  }
  /// A client that joins as the module CHAT.
  std::unique_ptr<SocketClient> JoinAsChat() const {
    auto chat = SocketClient::Unix(folder_ / "hub");
    chat->WriteLine("to @AM set Name = CHAT");
    chat->WriteLine("rep Run = LIVE");
    return chat;
  }
  std::string Address() const { return "http://" + host_ + "/"; }
  static std::string Type(const std::string& words) {
    return "do:document.querySelector('#text').value = '" + words +
           "'; document.querySelector('#speak button').click()";
  }
  static std::string Choose(const std::string& picker, const std::string& value) {
    return "do:document.querySelector('#pick-" + picker + "').value = '" + value +
           "'; document.querySelector('#pick-" + picker + "').onchange()";
  }
  static std::string Tell(const std::string& text) {
    return "do:galatea.hub.send('to @CONSOLE tell " + text + "')";
  }
};

/// The engineer's view.
TEST_F(WebPageTest, AnEngineerSeesModulesSlotsAndMessages) {
  const auto page = Browse(
      {"do:document.querySelector('#engineer-tab').click()",
       "wait:document.querySelector('#modules td.READY')",
       "wait:[...document.querySelectorAll('#whose option')].some(o => o.value == 'FSM')",
       "do:document.querySelector('#line').value = 'to @CONSOLE set Seen = 5'; "
       "document.querySelector('#line-form button').click()",
       "wait:document.querySelector('#flow').textContent.includes('set#u')",
       "do:document.querySelector('[aria-label=\"Restart FSM\"]').click()",
       "wait:document.querySelector('#answer').textContent == 'READY'",
       "wait:document.querySelector('#modules summary').textContent.includes('ended with')",
       "do:document.querySelector('#whose').value = 'AM'; "
       "document.querySelector('#whose').onchange()",
       "wait:[...document.querySelectorAll('#slots summary')].some(s => "
       "s.textContent.startsWith('the hub'))",
       "do:document.querySelector('#slot-filter').value = 'protocolv'; "
       "document.querySelector('#slot-filter').oninput()",
       "wait:document.querySelector('#slots details[open] [aria-label=ProtocolVersion]')"
       ".value.includes('1.0')",
       "print:[...document.querySelectorAll('#slots tr')].filter(r => r.checkVisibility()).length",
       "print:location.href", "picture:" + (folder_ / "page.png"),
       "do:location.href = 'module.html'",
       "wait:document.querySelector('#flow').textContent.includes('inq Clock')",
       "print:document.title"});
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(), "1") << "of all slots the filter shows one";
  EXPECT_EQ(page->ReadLine(), Address()) << "the token has left the address";
  EXPECT_EQ(page->ReadLine(), "A page as a module of Galatea");
  EXPECT_TRUE(hub_->Expect("Seen = 5")) << "what was typed arrived";
  EXPECT_TRUE(hub_->Expect("From @PAGE rep Run = LIVE")) << "the other page is a module";
}

TEST_F(WebPageTest, ATypedLineGoesToWhoAnswersAndTheLogHasWhatBothSay) {
  const auto page =
      Browse({"wait:document.querySelector('#way').dataset.text == 'way_voice'", Tell("alone"),
              "wait:document.querySelector('#way').dataset.text == 'way_chat'", Type("Hello there"),
              "wait:document.querySelector('#status').textContent == 'thinking …'",
              "wait:document.querySelector('#subtitle').textContent == 'Good day.'",
              "print:document.querySelector('#log').innerText.replace(/\\s+/g, ' ')",
              "do:document.querySelector('#hush').click()",
              "wait:document.querySelector('#log').innerText.includes('interrupted')",
              "wait:document.querySelector('#subtitle').textContent == ''"});
  ASSERT_TRUE(hub_->Expect("tell alone")) << page->ErrorText();
  const auto chat = JoinAsChat();
  ASSERT_TRUE(chat->Expect("inq Listen")) << page->ErrorText();
  chat->WriteLine("rep Listen = ON");
  EXPECT_TRUE(chat->Expect("Input.text = Hello there")) << page->ErrorText() << chat->Seen();
  chat->WriteLine("rep Heard = Hello there");
  chat->WriteLine("rep Busy = THINKING");
  for (const char* line :
       {"rep Speak.text = Good day.", "rep Speak.dur = 900", "rep Speak.stat = SPEAKING"})
    chat->WriteLine("to @SSM set Tell = " + std::string(line));
  ASSERT_TRUE(chat->Expect("Say = STOP")) << page->ErrorText();
  for (const char* line : {"rep Speak.len = 400", "rep Speak.stat = IDLE"})
    chat->WriteLine("to @SSM set Tell = " + std::string(line));
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(), "You Hello there Galatea Good day.");
}

TEST_F(WebPageTest, APageOpenedAnewShowsWhatWasSaidAndGreetsWhereNothingWas) {
  const std::string log =
      "print:document.querySelector('#log').innerText.replace(/\\s+/g, ' ').trim()";
  const auto page =
      Browse({Tell("here"), "wait:document.querySelector('#log p')", log, "do:location.reload()",
              "wait:document.querySelector('#log p.you')",
              "wait:document.querySelector('#status').textContent == 'thinking …'", log});
  ASSERT_TRUE(hub_->Expect("tell here")) << page->ErrorText();
  const auto chat = JoinAsChat();
  ASSERT_TRUE(chat->Expect("inq History")) << page->ErrorText();
  chat->WriteLine("rep History = []");
  ASSERT_TRUE(chat->Expect("inq History")) << page->ErrorText();
  chat->WriteLine(
      R"(rep History = [{"content":"Hello","role":"user"},{"content":"Good day.","role":"assistant"},)"
      R"({"content":"And\nnow?","role":"user"}])");
  ASSERT_TRUE(chat->Expect("inq Busy")) << page->ErrorText();
  chat->WriteLine("rep Busy = THINKING");
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(), "Galatea is here. Ask something.");
  EXPECT_EQ(page->ReadLine(), "You Hello Galatea Good day. You And You now?");
}

TEST_F(WebPageTest, TheLanguagesAreThoseOfTheVoiceAndOfWhoAnswers) {
  const std::string codes =
      "[...document.querySelector('#pick-language').options].map(o => o.value).join()";
  const auto page = Browse({"wait:" + codes + " == 'AUTO,en,ja'", Tell("own"),
                            "wait:" + codes + " == 'AUTO,en,ja,de'",
                            "print:[...document.querySelector('#pick-language').options].map(o => "
                            "o.textContent).join()",
                            Choose("language", "de")});
  ASSERT_TRUE(hub_->Expect("tell own")) << page->ErrorText();
  const auto chat = JoinAsChat();
  ASSERT_TRUE(chat->Expect("inq Language.all")) << page->ErrorText() << chat->Seen();
  chat->WriteLine("rep Language.all = *");
  EXPECT_TRUE(hub_->Expect("tell speaks as carl")) << page->ErrorText();
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(), "automatic,English,日本語 (typed only),Deutsch (typed only)");
}

TEST_F(WebPageTest, AnAnswerIsReadWhereTheVoiceIsAwayAndNobodyToAnswerIsNamed) {
  const auto page = Browse(
      {Tell("here"), "wait:document.querySelector('#way').dataset.text == 'way_chat'",
       "do:galatea.hub.send('to @AM set Stop = SSM')",
       "wait:document.querySelector('#way').dataset.text == 'way_chat_silent'", Type("Hello"),
       "wait:document.querySelector('#log').innerText.includes('Be well.')", Tell("read"),
       "wait:document.querySelector('#way').dataset.text == 'way_no_chat'", Type("Still there?"),
       "print:document.querySelector('#log').innerText.replace(/\\s+/g, ' ')",
       "print:document.querySelector('#text').value"});
  ASSERT_TRUE(hub_->Expect("tell here")) << page->ErrorText();
  auto chat = JoinAsChat();
  ASSERT_TRUE(chat->Expect("inq Listen")) << page->ErrorText();
  chat->WriteLine("rep Listen = ON");
  ASSERT_TRUE(chat->Expect("Input.text = Hello")) << page->ErrorText() << chat->Seen();
  for (const char* line : {"rep Busy = THINKING", "rep Reply.sentence = Good day.",
                           "rep Say.error = UNAVAILABLE the voice @SSM is not there",
                           "rep Reply.sentence = Be well.", "rep Busy = IDLE"})
    chat->WriteLine(line);
  ASSERT_TRUE(hub_->Expect("tell read")) << page->ErrorText();
  chat.reset();
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(
      page->ReadLine(),
      "You Hello Galatea Good day. The voice (module SSM) is not there: answers can only be "
      "read. Galatea Be well. You Still there? Nobody answers: the module CHAT is not there.");
}

TEST_F(WebPageTest, AVoiceThatDiesInTheMiddleLeavesTheWholeAnswerToRead) {
  const auto page =
      Browse({Tell("here"), "wait:document.querySelector('#way').dataset.text == 'way_chat'",
              Type("Hello"), "wait:document.querySelector('#subtitle').textContent == 'Good day.'",
              "do:galatea.hub.send('to @AM set Stop = SSM')",
              "wait:document.querySelector('#way').dataset.text == 'way_chat_silent'", Tell("gone"),
              "wait:document.querySelector('#log').innerText.includes('Be well.')",
              "print:document.querySelector('#log').innerText.replace(/\\s+/g, ' ')"});
  ASSERT_TRUE(hub_->Expect("tell here")) << page->ErrorText();
  const auto chat = JoinAsChat();
  ASSERT_TRUE(chat->Expect("inq Listen")) << page->ErrorText();
  chat->WriteLine("rep Listen = ON");
  ASSERT_TRUE(chat->Expect("Input.text = Hello")) << page->ErrorText() << chat->Seen();
  for (const char* line : {"rep Busy = THINKING", "rep Reply.sentence = Good day.",
                           "to @SSM set Tell = rep Speak.text = Good day.",
                           "to @SSM set Tell = rep Speak.stat = SPEAKING"})
    chat->WriteLine(line);
  ASSERT_TRUE(hub_->Expect("tell gone")) << page->ErrorText();
  for (const char* line : {"rep Say.error = UNAVAILABLE @SSM has gone in the middle of it",
                           "rep Reply.sentence = Be well.", "rep Busy = IDLE"})
    chat->WriteLine(line);
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(),
            "You Hello Galatea Good day. The voice (module SSM) is not there: answers can only be "
            "read. Galatea Be well.");
}

TEST_F(WebPageTest, WhatIsTypedAsSoonAsThePageIsConnectedWaitsUntilItKnowsWhoIsThere) {
  const auto chat = JoinAsChat();
  const auto page = Browse(
      {"wait:document.querySelector('#way').dataset.text == 'way_chat'",
       "do:new MutationObserver(() => { if "
       "(document.querySelector('#link.on') && !window.said) { window.said = "
       "document.querySelector('#way').dataset.text; " +
           Type("Early").substr(3) + "; for (let k = 0; k < 20; ++k) { " + Type("Again").substr(3) +
           "} } }).observe(document.querySelector('#link'), {attributes: true}); "
           "galatea.hub.socket.close()",
       "wait:window.said", "wait:document.querySelector('#log').innerText.includes('Early')",
       "print:window.said",
       "print:[...document.querySelectorAll('#log p')].map(p => p.innerText.replace(/\\s+/g, ' "
       "')).slice(0, "
       "2).join('; ')"});
  for (int visit = 0; visit < 2; ++visit) {
    ASSERT_TRUE(chat->Expect("inq Listen")) << page->ErrorText();
    chat->WriteLine("rep Listen = ON");
  }
  EXPECT_TRUE(chat->Expect("Input.text = Early")) << page->ErrorText() << chat->Seen();
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_NE(page->ReadLine(), "way_chat") << "it was typed before the module was known";
  EXPECT_EQ(
      page->ReadLine(),
      "The agent is still starting and no more lines are kept; send this one again when it is "
      "there.; You Early");
}

TEST_F(WebPageTest, ADialogueBeginsWithThePageAndCanBeStartedAgain) {
  Process dialog({GALATEA_SOURCE_DIR "/scripts/web_dialog.py", "--connect",
                  "unix:" + (folder_ / "hub"), "--name", "DIALOG", "--", "sh", "-c",
                  "echo begun; sleep 1"});
  const auto page =
      Browse({"wait:!document.querySelector('#again').hidden",
              "do:document.querySelector('#again').click()",
              "wait:document.querySelector('#again').hidden",
              "wait:!document.querySelector('#again').hidden", Type("Hello"),
              "print:document.querySelector('#log').innerText.replace(/\\s+/g, ' ')"});
  EXPECT_TRUE(dialog.Expect("begun")) << dialog.ErrorText();
  EXPECT_TRUE(dialog.Expect("run_agent: the dialogue is over")) << dialog.ErrorText();
  EXPECT_TRUE(dialog.Expect("begun")) << "again";
  EXPECT_EQ(page->Wait(support::Millis(60000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(),
            "The dialogue is over. The dialogue is over. You Hello The dialogue is over: nobody "
            "listens.");
}

TEST_F(WebPageTest, OnANarrowPageThePickersFoldAndLogAndButtonsStayInView) {
  const std::string settle = "do:new Promise(done => setTimeout(done, 300))";
  const std::string seen =
      "print:['#log', '#text', '#microphone'].every(each => "
      "document.querySelector(each).getBoundingClientRect().bottom <= innerHeight) + ' ' + "
      "document.querySelector('#settings').open";
  const auto page =
      Browse({"size:1280x850", settle, seen, "size:400x850", settle, seen, "size:820x850", settle,
              seen, "do:document.querySelector('#settings summary').click()", settle,
              "print:document.querySelector('#pick-face').checkVisibility()", "size:1280x850",
              settle, seen});
  EXPECT_EQ(page->Wait(support::Millis(60000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(), "true true");
  EXPECT_EQ(page->ReadLine(), "true false");
  EXPECT_EQ(page->ReadLine(), "true false");
  EXPECT_EQ(page->ReadLine(), "True") << "they can be unfolded";
  EXPECT_EQ(page->ReadLine(), "true true");
}

TEST_F(WebPageTest, AFaceThatHasDrawnNothingYetIsSaidToDrawNothing) {
  hub_->WriteLine("to @FSM set#off Frames = OFF");
  ASSERT_TRUE(hub_->Expect("rep#off Frames = OFF")) << hub_->ErrorText();
  const auto page =
      Browse({"wait:document.querySelector('#face-off').textContent.includes('draws nothing')",
              Tell("none"), "wait:!document.querySelector('#stage.off')"});
  ASSERT_TRUE(hub_->Expect("tell none")) << page->ErrorText();
  hub_->WriteLine("to @FSM set Frames = ON");
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
}

TEST_F(WebPageTest, WhatHasGoneSaysSoAndWhatComesBackIsAsItWasChosen) {
  const auto page = Browse(
      {"wait:document.querySelector('#face').width === 16 && "
       "!document.querySelector('#stage.off')",
       "wait:document.querySelector('#pick-face').value == 'galatea'",
       "wait:document.querySelector('#pick-voice').value == 'anna'", Choose("face", "pygmalion"),
       Choose("voice", "ben"), Tell("chosen"), "wait:document.querySelector('#stage.off')",
       "wait:document.querySelector('#face-off').textContent == 'No face: its module is not "
       "running. Trying again.'",
       Tell("seen to go"), "wait:!document.querySelector('#stage.off')",
       "wait:!document.querySelector('#pick-face').disabled",
       "wait:document.querySelector('#pick-voice').disabled", Tell("seen the voice go"),
       "wait:!document.querySelector('#pick-voice').disabled",
       "print:document.querySelector('#pick-face').value"});
  ASSERT_TRUE(hub_->ExpectAll({"tell wears pygmalion", "tell speaks as ben", "tell chosen"}))
      << page->ErrorText() << hub_->ErrorText() << hub_->Seen();
  hub_->WriteLine("set Stop = FSM");
  ASSERT_TRUE(hub_->Expect("tell seen to go")) << page->ErrorText();
  hub_->WriteLine("set Start = FSM");
  EXPECT_TRUE(hub_->Expect("tell wears pygmalion")) << "again";
  hub_->WriteLine("set Stop = SSM");
  ASSERT_TRUE(hub_->Expect("tell seen the voice go")) << page->ErrorText();
  hub_->WriteLine("set Start = SSM");
  EXPECT_TRUE(hub_->Expect("tell speaks as ben")) << "again";
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(), "pygmalion");
}

TEST_F(WebPageTest, AModuleComesBackAsThePageFoundIt) {
  hub_->WriteLine("to @FSM set Mask = pygmalion");
  ASSERT_TRUE(hub_->Expect("tell wears pygmalion"));
  const auto page =
      Browse({"wait:document.querySelector('#face').width === 16 && "
              "!document.querySelector('#stage.off')",
              "wait:document.querySelector('#pick-face').value == 'pygmalion'",
              "wait:document.querySelector('#pick-emotion').value == 'ANGRY'",
              "print:document.querySelector('#strength').textContent", Tell("found"),
              "wait:document.querySelector('#stage.off')", Tell("seen to go"),
              "wait:!document.querySelector('#stage.off')",
              "wait:!document.querySelector('#pick-face').disabled",
              "print:document.querySelector('#pick-face').value"});
  ASSERT_TRUE(hub_->Expect("tell found")) << page->ErrorText();
  hub_->WriteLine("set Stop = FSM");
  ASSERT_TRUE(hub_->Expect("tell seen to go")) << page->ErrorText();
  hub_->WriteLine("set Start = FSM");
  EXPECT_TRUE(hub_->Expect("tell wears pygmalion")) << "though nobody has chosen it here";
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(), "60 %");
  EXPECT_EQ(page->ReadLine(), "pygmalion");
}

TEST_F(WebPageTest, ThePickersFollowTheExpressionWhoeverSetsItExceptWhileTheyHaveTheFocus) {
  const std::string shown =
      "document.querySelector('#pick-emotion').value + ' ' + "
      "document.querySelector('#strength').textContent";
  const std::string wait = "wait:" + shown + " == ";
  const auto page = Browse(
      {wait + "'ANGRY 60 %'", Choose("emotion", "SAD"), Tell("chosen"), wait + "'HAPPY 75 %'",
       "print:document.querySelector('#face').getAttribute('aria-label')",
       "do:document.querySelector('#pick-emotion').focus()", Tell("has the focus"),
       "wait:document.querySelector('#pick-voice').value == 'ben'", "print:" + shown,
       "do:document.querySelector('#pick-emotion').blur()", wait + "'SMIRK 100 %'", Tell("left"),
       wait + "'FEARED 40 %'", wait + "'NEUTRAL 40 %'", "do:location.reload()",
       "wait:document.querySelector('#link.on') && "
       "document.querySelector('#pick-face').value == 'galatea' && " +
           shown + " == 'FEARED 40 %'"});
  const auto set_expression = [this](const std::string& value) {
    hub_->WriteLine("to @FSM set FaceExp = " + value);
    return hub_->Expect("rep FaceExp = " + value);
  };
  EXPECT_TRUE(hub_->Expect("tell chosen")) << page->ErrorText() << hub_->Seen();
  hub_->WriteLine("to @AM-MCL set Emotion = HAPPY 75");
  EXPECT_TRUE(hub_->Expect("tell has the focus")) << page->ErrorText();
  EXPECT_TRUE(set_expression("SMIRK"));
  hub_->WriteLine("to @SSM set Tell = rep Speaker = ben");
  EXPECT_TRUE(hub_->Expect("tell left")) << page->ErrorText();
  EXPECT_TRUE(set_expression("FEARED 1 40 2000"));
  EXPECT_EQ(page->Wait(support::Millis(120000)), 0) << page->ErrorText() << hub_->ErrorText();
  EXPECT_EQ(page->ReadLine(), "the face, galatea, happy");
  EXPECT_EQ(page->ReadLine(), "HAPPY 75 %") << "while somebody is at the picker";
}

TEST_F(WebPageTest, AnOpenPageGoesOnWhenTheHubHasBeenStartedAnew) {
  const support::TempDir state;
  const unsigned short port = FreePort();
  auto first = std::make_unique<PlainHub>(state / "", port);
  Process page(
      {"python3", GALATEA_SOURCE_DIR "/tests/support/browse.py", Chromium(), folder_ / "profile",
       first->address, "--lang=en", "wait:document.querySelector('#link.on')",
       "do:galatea.hub.send('to @CONSOLE tell there')", "wait:document.querySelector('#link.off')",
       "wait:document.querySelector('#link.on')", "wait:galatea.clock.known",
       "do:galatea.hub.send('to @CONSOLE tell there again')",
       "print:document.querySelector('#link').textContent"});
  ASSERT_TRUE(first->hub.Expect("tell there")) << page.ErrorText();
  first.reset();
  PlainHub second(state / "", port);
  EXPECT_TRUE(second.hub.Expect("tell there again")) << page.ErrorText();
  EXPECT_EQ(page.Wait(support::Millis(60000)), 0) << page.ErrorText();
  EXPECT_EQ(page.ReadLine(), "connected");
}

}  // namespace
