// The hub's web server: what it gives to those who may see it, and what others get.

#include <sys/stat.h>

#include "tests/agent_manager/web_support.h"

namespace {

using namespace web_support;

TEST_F(WebTest, OnlyTheTokenOpensThePage) {
  EXPECT_EQ(StatusOf("/", Host()), "401");
  EXPECT_EQ(StatusOf("/?token=wrong", Host()), "401");
  EXPECT_EQ(StatusOf("/", Host() + "Cookie: " + CookieName() + "=\r\n"), "401");
  EXPECT_EQ(StatusOf("/ws", Host() + Socket("http://" + host_)), "401");
  EXPECT_EQ(StatusOf("/", Host() + "Authorization: bearer " + kToken + "\r\n"), "200");
  EXPECT_EQ(StatusOf("/", "Host: LOCALHOST:" + std::to_string(port_) + "\r\n" + Cookie()), "200");
  EXPECT_TRUE(hub_->ExpectError("web page: refused a request without the token from 127.0.0.1"));
  const auto first = Open("/?token=" + kToken, Host());
  EXPECT_TRUE(first->Expect("303 See Other"));
  EXPECT_TRUE(first->Expect("Location: /"));
  EXPECT_TRUE(first->Expect("HttpOnly; SameSite=Strict"));
  const auto page = Open("/", Host() + Cookie());
  EXPECT_TRUE(page->Expect("200 OK"));
  EXPECT_TRUE(page->Expect("Content-Security-Policy: default-src 'self'"));
  EXPECT_TRUE(page->Expect("<title>Galatea</title>"));
}

TEST_F(WebTest, WhoShowsNoTokenIsToldWhereThereIsOne) {
  const auto stranger = Open("/", Host());
  EXPECT_TRUE(stranger->Expect("WWW-Authenticate: Bearer")) << stranger->Seen();
  EXPECT_TRUE(
      stranger->Expect("Unauthorized: a request without the token; the program that serves "
                       "this prints its address, which ends in ?token=TOKEN"))
      << stranger->Seen();
  for (const std::string& shown :
       {"/?token=wrong HTTP/1.1\r\n" + Host(),
        "/ HTTP/1.1\r\n" + Host() + "Cookie: " + CookieName() + "=old\r\n",
        "/ HTTP/1.1\r\n" + Host() + "Authorization: Bearer old\r\n"}) {
    auto client = SocketClient::Tcp(port_);
    client->Write("GET " + shown + "\r\n");
    EXPECT_TRUE(client->Expect("a request with a wrong token; the program")) << client->Seen();
  }
}

TEST_F(WebTest, NoPathLeadsOutOfThePage) {
  for (const char* path :
       {"/../../../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd", "/..\\etc\\passwd",
        "/app.js/../../etc/passwd", "/page/app.js", "/token"}) {
    EXPECT_EQ(StatusOf(path, Host() + Cookie()), "404") << path;
  }
  EXPECT_EQ(StatusOf("/app.js", Host() + Cookie()), "200");
}

TEST_F(WebTest, OtherSitesAndHostsAreRefused) {
  EXPECT_EQ(StatusOf("/", "Host: evil.example\r\n" + Cookie()), "421");
  EXPECT_EQ(StatusOf("/ws", Host() + Cookie() + Socket("http://evil.example")), "403");
  EXPECT_TRUE(hub_->ExpectError("a page of the site http://evil.example"));
  EXPECT_EQ(StatusOf("/ws", Host() + Cookie() + Socket("http://" + host_)), "101");
}

TEST_F(WebTest, OversizedRequestsAndMessagesAreRefused) {
  EXPECT_EQ(StatusOf("/", Host() + Cookie() + "X-Long: " + std::string(20000, 'x') + "\r\n"),
            "413");
  const auto socket = Open("/ws", Host() + Cookie() + Socket(""));
  ASSERT_TRUE(socket->Expect("101 Switching"));
  socket->Write(Frame("to @AM set#1 Name = LOUD"));
  socket->Write(Frame(std::string(70000, 'x')));
  EXPECT_TRUE(hub_->ExpectError("web page: refused a message over 65536 bytes"));
  // A length no memory has.
  const auto other = Open("/ws", Host() + Cookie() + Socket(""));
  ASSERT_TRUE(other->Expect("101 Switching"));
  other->Write(std::string("\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff\0\0\0\0", 14));
  other->ReadAll();
  EXPECT_TRUE(other->AtEnd());
  hub_->WriteLine("inq#1 Modules");
  EXPECT_TRUE(hub_->Expect("rep#1 Modules = "));
}

TEST_F(WebTest, AWebSocketIsAPeerThatCanBeAModule) {
  const auto socket = Open("/ws", Host() + Cookie() + Socket("http://" + host_));
  ASSERT_TRUE(socket->Expect("101 Switching"));
  socket->Write(Frame("to @AM set Name = PAGE"));
  socket->Write(Frame("from @FSM to @CONSOLE tell hello\nto @CONSOLE tell again"));
  EXPECT_TRUE(hub_->Expect("From @PAGE tell hello")) << hub_->Seen();
  EXPECT_TRUE(hub_->Expect("From @PAGE tell again"));
  // As a module it is asked for its clock: the hub's first tag for it.
  socket->Write(Frame("rep Run = LIVE"));
  EXPECT_TRUE(hub_->Expect("From @PAGE rep Run = LIVE"));
  socket->Write(Frame("\x01\x02 nonsense"));
  socket->CloseInput();
  hub_->WriteLine("to @FSM inq#1 Run");
  EXPECT_TRUE(hub_->Expect("From @FSM rep#1 Run = LIVE"));
}

TEST_F(WebTest, TheFaceComesAsPicturesWhileSomebodyLooks) {
  {
    const auto video = Open("/face.mjpg", Host() + Cookie());
    ASSERT_TRUE(video->Expect("200 OK")) << hub_->ErrorText();
    EXPECT_TRUE(video->Expect("multipart/x-mixed-replace; boundary=picture"));
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(video->Expect("Content-Type: image/jpeg")) << i;
  }
  EXPECT_TRUE(hub_->Expect("From @FSM tell pictures to NONE")) << "nobody looks any more";
}

TEST_F(WebTest, ViewersWhoHaveClosedTakeNoPlaceWhileAFaceDrawsNothing) {
  hub_->WriteLine("to @FSM set#off Frames = OFF");
  ASSERT_TRUE(hub_->Expect("rep#off Frames = OFF"));
  constexpr int kMoreThanThereArePlaces = 80;
  for (int i = 0; i < kMoreThanThereArePlaces; ++i) {
    Open("/face.mjpg", Host() + Cookie());
    EXPECT_EQ(StatusOf("/", Host() + Cookie()), "200") << i;
  }
}

TEST_F(WebTest, WhatIsNoPictureEndsThePicturesAndSaysSo) {
  hub_->WriteLine("to @FSM set#off Frames = OFF");
  ASSERT_TRUE(hub_->Expect("rep#off Frames = OFF"));
  for (const char* record :
       {R"(picture 1 8388609\n)", R"(picture x 4\n)", R"(picture 1 2 3\n)", R"(film 1 4\n)"}) {
    const auto face = Open("/face", Host() + Cookie() + Socket("http://" + host_));
    ASSERT_TRUE(hub_->Expect("From @FSM tell pictures to unix:")) << hub_->Seen();
    hub_->WriteLine("to @FSM set Say = " + std::string(record));
    ASSERT_TRUE(hub_->Expect("From @FSM tell pictures to NONE")) << record;
    face->CloseInput();
    face->ReadAll();
    EXPECT_NE(face->Seen().find("expected picture MS BYTES"), std::string::npos) << record;
  }
  hub_->WriteLine("inq#alive Run");
  EXPECT_TRUE(hub_->Expect("rep#alive Run = LIVE")) << hub_->ErrorText();
}

TEST_F(WebTest, AFilmAndThePageDoNotDisturbEachOther) {
  hub_->WriteLine("to @FSM set Record = /dev/null");
  hub_->WriteLine("to @FSM inq#1 Record");
  ASSERT_TRUE(hub_->Expect("rep#1 Record = /dev/null"));
  const auto video = Open("/face.mjpg", Host() + Cookie());
  EXPECT_TRUE(video->Expect("Content-Type: image/jpeg")) << hub_->ErrorText();
  hub_->WriteLine("to @FSM inq#2 Record");
  EXPECT_TRUE(hub_->Expect("rep#2 Record = /dev/null"));
}

TEST_F(WebTest, PicturesThatSomebodyElseTakesAreNotTakenAway) {
  hub_->WriteLine("to @FSM set#1 Picture.to = elsewhere");
  ASSERT_TRUE(hub_->Expect("rep#1 Picture.to = elsewhere"));
  EXPECT_EQ(StatusOf("/face.mjpg", Host() + Cookie()), "503");
  hub_->WriteLine("to @FSM inq#2 Picture.to");
  EXPECT_TRUE(hub_->Expect("rep#2 Picture.to = elsewhere"));
}

TEST_F(WebTest, TheVoicesSoundComesWithItsTimeWhileSomebodyListens) {
  const std::string headers = Host() + Cookie() + Socket("http://" + host_);
  {
    const auto voice = Open("/voice", headers);
    ASSERT_TRUE(voice->Expect("101 Switching")) << hub_->ErrorText();
    ASSERT_TRUE(hub_->Expect("From @SSM tell sound to unix:")) << hub_->Seen();
    // In two pieces, the second of which begins within the samples.
    hub_->WriteLine(R"(to @SSM set#1 Say = sound 12.5 16000 4\nA)");
    hub_->WriteLine(R"(to @SSM set#2 Say = B\nCend 20\nsound 1 2 3\n)");
    // A line feed stands among the samples, as one may.
    EXPECT_TRUE(voice->Expect("AB")) << hub_->ErrorText();
    ASSERT_TRUE(hub_->Expect("From @SSM tell sound to NONE")) << hub_->Seen();
    // By the next answer the hub has written why, and the end of input cannot come before it.
    hub_->WriteLine("inq#3 Refused");
    ASSERT_TRUE(hub_->Expect("rep#3 Refused")) << hub_->Seen();
    voice->CloseInput();
    voice->ReadAll();
    EXPECT_NE(voice->Seen().find("the voice sent 'sound 1 2 3'"), std::string::npos)
        << "what is no record ends the sound and says so";
  }
  {
    const auto voice = Open("/voice", headers);
    ASSERT_TRUE(hub_->Expect("From @SSM tell sound to unix:")) << "as often as somebody comes";
  }
  EXPECT_TRUE(hub_->Expect("From @SSM tell sound to NONE")) << "nobody listens any more";
  EXPECT_EQ(StatusOf("/voice", Host() + Socket("")), "401");
  EXPECT_EQ(StatusOf("/voice", Host() + Cookie() + Socket("http://evil.example")), "403");
}

TEST_F(WebTest, TheFaceComesAsPicturesWithTimes) {
  const std::string headers = Host() + Cookie() + Socket("http://" + host_);
  {
    const auto face = Open("/face", headers);
    ASSERT_TRUE(face->Expect("101 Switching")) << hub_->ErrorText();
    EXPECT_TRUE(face->Expect("JFIF")) << hub_->ErrorText();
  }
  EXPECT_TRUE(hub_->Expect("From @FSM tell pictures to NONE")) << "nobody looks any more";
  EXPECT_EQ(StatusOf("/face", Host() + Socket("")), "401");
  EXPECT_EQ(StatusOf("/face", Host() + Cookie() + Socket("http://evil.example")), "403");
}

TEST_F(WebTest, MetricsAreInTheFormOfPrometheus) {
  hub_->WriteLine("set#1 Start = FSM");
  ASSERT_TRUE(hub_->Expect("rep#1 Start = READY"));
  const auto metrics = Open("/metrics", Host() + "Authorization: Bearer " + kToken + "\r\n");
  EXPECT_TRUE(metrics->Expect("200 OK"));
  EXPECT_TRUE(metrics->Expect("# TYPE galatea_messages_in_total counter"));
  EXPECT_TRUE(metrics->Expect("galatea_messages_in_total{peer=\"FSM\"} "));
  EXPECT_TRUE(metrics->Expect("galatea_module_ready{module=\"FSM\"} 1"));
}

TEST_F(WebTest, AMicrophoneBecomesTheEarsInputAndThenNoMore) {
  hub_->WriteLine("to @SRM set#1 Listen = START");
  ASSERT_TRUE(hub_->Expect("rep#1 Listen = START"));
  {
    const auto microphone = Open("/microphone", Host() + Cookie() + Socket("http://" + host_));
    ASSERT_TRUE(microphone->Expect("101 Switching")) << hub_->ErrorText();
    EXPECT_EQ(StatusOf("/microphone", Host() + Cookie() + Socket("http://" + host_)), "409")
        << "one at a time";
    std::string samples;  // half a second of 1000 Hz at 16 kHz
    for (int i = 0; i < 8000; ++i)
      samples += i % 16 < 8 ? std::string("\0\x20", 2) : std::string("\0\xe0", 2);
    std::string frame = Frame(samples);
    frame[0] = '\x82';  // binary
    microphone->Write(frame);
    // 499 times through zero in half a second.
    EXPECT_TRUE(hub_->Expect("From @SRM rep Result = 998")) << hub_->Seen() << hub_->ErrorText();
  }
  EXPECT_TRUE(hub_->Expect("From @SRM tell input to NONE")) << "as it was before" << hub_->Seen();
  EXPECT_EQ(StatusOf("/microphone", Host() + Socket("")), "401");
  EXPECT_EQ(StatusOf("/microphone", Host() + Cookie() + Socket("http://evil.example")), "403");
}

TEST_F(WebTest, WhatIsSaidWhileTheEarMakesItselfReadyIsKept) {
  hub_->WriteLine("to @SRM set#1 Listen = START");
  hub_->WriteLine("to @SRM set#2 Slow = YES");
  ASSERT_TRUE(hub_->Expect("rep#2 Slow = YES"));
  const auto microphone = Open("/microphone", Host() + Cookie() + Socket("http://" + host_));
  ASSERT_TRUE(microphone->Expect("101 Switching")) << hub_->ErrorText();
  std::string second;
  for (int i = 0; i < 16000; ++i)
    second += i % 16 < 8 ? std::string("\0\x20", 2) : std::string("\0\xe0", 2);
  std::string frame = Frame(second);
  frame[0] = '\x82';  // binary
  for (int i = 0; i < 4; ++i) microphone->Write(frame);
  for (int half = 0; half < 8; ++half)
    EXPECT_TRUE(hub_->Expect("From @SRM rep Result = 998")) << half << hub_->Seen();
}

TEST_F(WebTest, AMicrophoneThatGoesWhileTheEarIsSilentLeavesItsPlaceToTheNext) {
  const std::string headers = Host() + Cookie() + Socket("http://" + host_);
  hub_->WriteLine("to @SRM set#1 Deaf = YES");
  ASSERT_TRUE(hub_->Expect("rep#1 Deaf = YES"));
  {
    const auto microphone = Open("/microphone", headers);
    ASSERT_TRUE(microphone->Expect("101 Switching")) << hub_->ErrorText();
    EXPECT_EQ(StatusOf("/microphone", headers), "409");
  }
  EXPECT_TRUE(support::Becomes([&] { return StatusOf("/microphone", headers) == "101"; }));
}

TEST_F(WebTest, WhatABrowsersMicrophoneHearsTheEarUnderstands) {
  const char* const browser = Chromium();
  if (browser == nullptr)
    GTEST_SKIP() << "no chromium here (Debian package chromium-headless-shell or chromium)";
  const std::string sound = folder_ / "tone.wav";
  ASSERT_EQ(std::system(("python3 -c \"import wave, math, struct; w = wave.open('" + sound +
                         "', 'wb'); w.setparams((1, 2, 48000, 0, 'NONE', '')); "
                         "w.writeframes(b''.join(struct.pack('<h', int(12000 * math.sin(i * "
                         "math.tau * 500 / 48000))) for i in range(96000)))\"")
                            .c_str()),
            0);
  Process page(
      {"python3", GALATEA_SOURCE_DIR "/tests/support/browse.py", browser, folder_ / "profile",
       "http://" + host_ + "/module.html?token=" + kToken, "--use-fake-ui-for-media-stream",
       "--use-fake-device-for-media-stream", "--use-file-for-fake-audio-capture=" + sound,
       "--autoplay-policy=no-user-gesture-required", "wait:document.querySelector('#link.on')",
       "wait:document.querySelector('#flow').textContent.includes('inq Clock')",
       "do:document.querySelector('#listen').click()",
       "wait:/^(49|50)\\d$/.test(document.querySelector('#said').textContent)",
       "picture:" + (folder_ / "microphone.png"), "do:document.querySelector('#listen').click()",
       "wait:document.querySelector('#said').textContent == 'Not listening.'"});
  EXPECT_EQ(page.Wait(support::Millis(120000)), 0) << page.ErrorText() << hub_->ErrorText();
  EXPECT_TRUE(hub_->Expect("From @PAGE rep Listen = ON")) << hub_->Seen();
  EXPECT_TRUE(hub_->Expect("From @PAGE rep Result = ")) << "what it hears is its Result";
}

TEST(WebTokenTest, OneThatNobodyHasSetStaysTheSameForAPortAndIsReadableByTheUserAlone) {
  const support::TempDir state;
  const unsigned short port = FreePort();
  const auto address = [&](const std::string& at) { return PlainHub(at, port).address; };
  const std::string file = state / ("galatea/page_token_" + std::to_string(port));
  const auto first = address(state / "");
  EXPECT_EQ(address(state / ""), first);
  struct stat info {};
  ASSERT_EQ(stat(file.c_str(), &info), 0) << file;
  EXPECT_EQ(info.st_mode & 0777, 0600U);
  chmod(file.c_str(), 0644);
  const auto second = address(state / "");
  EXPECT_NE(second, first) << "others may have read it";
  ASSERT_EQ(stat(file.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0600U);
  std::ofstream(file) << "short\n";
  EXPECT_EQ(address(state / "").size(), first.size());
  EXPECT_NE(address("/dev/null"), address("/dev/null"))
      << "where none can be kept there is one all the same";
}

}  // namespace
