#include <gtest/gtest.h>

#include "task_manager/fetch/fetcher.h"
#include "task_manager/fetch/uri.h"
#include "tests/task_manager/case_file.h"
#include "tests/task_manager/http_server.h"

namespace vxml_test {
namespace {

using vxml::fetch::Fetcher;
using vxml::fetch::Options;
using vxml::fetch::Request;
using vxml::fetch::Resolve;

/// A fetcher whose clock the test moves.
class FetcherTest : public ::testing::Test {
 protected:
  Options WithClock() {
    Options options;
    options.now = [this] { return now_; };
    return options;
  }
  Request For(const std::string& uri) {
    Request request;
    request.uri = uri;
    return request;
  }
  long long now_ = 1'000'000'000;
};

TEST(UriTest, ReferencesAreResolvedAsTheRfcSays) {
  const std::string base = "http://a/b/c/d;p?q";
  EXPECT_EQ(Resolve(base, "g"), "http://a/b/c/g");
  EXPECT_EQ(Resolve(base, "./g/"), "http://a/b/c/g/");
  EXPECT_EQ(Resolve(base, "/g"), "http://a/g");
  EXPECT_EQ(Resolve(base, "//g"), "http://g");
  EXPECT_EQ(Resolve(base, "?y"), "http://a/b/c/d;p?y");
  EXPECT_EQ(Resolve(base, "#s"), "http://a/b/c/d;p?q#s");
  EXPECT_EQ(Resolve(base, "../../../g"), "http://a/g");
  EXPECT_EQ(Resolve(base, ""), "http://a/b/c/d;p?q");
  EXPECT_EQ(Resolve(base, "g;x=1/../y"), "http://a/b/c/y");
  EXPECT_EQ(Resolve(base, "file:/x"), "file:/x");
}

TEST_F(FetcherTest, FreshAnswersComeFromTheCache) {
  HttpServer server([](const auto&) { return Answer("x", "Cache-Control: max-age=60\r\n"); });
  Fetcher fetcher(WithClock());
  EXPECT_FALSE(fetcher.Fetch(For(server.Url("/a")))->from_cache);
  now_ += 59;
  EXPECT_TRUE(fetcher.Fetch(For(server.Url("/a")))->from_cache);
  now_ += 2;
  EXPECT_FALSE(fetcher.Fetch(For(server.Url("/a")))->from_cache);
  EXPECT_EQ(server.requests().size(), 2U);
}

TEST_F(FetcherTest, MaxageRefusesWhatIsOlder) {
  HttpServer server([](const auto&) { return Answer("x", "Cache-Control: max-age=600\r\n"); });
  Fetcher fetcher(WithClock());
  ASSERT_TRUE(fetcher.Fetch(For(server.Url("/a"))));
  now_ += 10;
  Request request = For(server.Url("/a"));
  request.max_age = 5;
  EXPECT_FALSE(fetcher.Fetch(request)->from_cache);
}

TEST_F(FetcherTest, MaxstaleTakesWhatIsStale) {
  HttpServer server([](const auto&) { return Answer("x", "Cache-Control: max-age=1\r\n"); });
  Fetcher fetcher(WithClock());
  ASSERT_TRUE(fetcher.Fetch(For(server.Url("/a"))));
  now_ += 10;
  Request request = For(server.Url("/a"));
  request.max_stale = 30;
  EXPECT_TRUE(fetcher.Fetch(request)->from_cache);
}

TEST_F(FetcherTest, AnEtagIsAskedAbout) {
  HttpServer server([](const HttpServer::Request& request) {
    if (request.headers.find("if-none-match: \"v1\"") != std::string::npos) {
      return Answer("", "", "304 Not Modified");
    }
    return Answer("x", "ETag: \"v1\"\r\nCache-Control: no-cache\r\n");
  });
  Fetcher fetcher(WithClock());
  ASSERT_TRUE(fetcher.Fetch(For(server.Url("/a"))));
  const auto again = fetcher.Fetch(For(server.Url("/a")));
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->from_cache);
  EXPECT_EQ(again->body, "x");
}

TEST_F(FetcherTest, NoStoreIsNotKept) {
  HttpServer server(
      [](const auto&) { return Answer("x", "Cache-Control: no-store, max-age=60\r\n"); });
  Fetcher fetcher(WithClock());
  ASSERT_TRUE(fetcher.Fetch(For(server.Url("/a"))));
  EXPECT_FALSE(fetcher.Fetch(For(server.Url("/a")))->from_cache);
}

TEST_F(FetcherTest, RedirectionsAreFollowedButNotInCircles) {
  HttpServer server([](const HttpServer::Request& request) {
    if (request.target == "/end") return Answer("x");
    return Answer("", "Location: " + std::string(request.target == "/a" ? "/end" : "/b") + "\r\n",
                  "302 Found");
  });
  Fetcher fetcher(WithClock());
  EXPECT_EQ(fetcher.Fetch(For(server.Url("/a")))->uri, server.Url("/end"));
  EXPECT_FALSE(fetcher.Fetch(For(server.Url("/b"))));
}

TEST_F(FetcherTest, ARedirectionToAFileIsRefused) {
  HttpServer server(
      [](const auto&) { return Answer("", "Location: file:///etc/passwd\r\n", "302 Found"); });
  Fetcher fetcher(WithClock());
  const auto got = fetcher.Fetch(For(server.Url("/a")));
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error().code, vm::Errc::kAccess);
}

TEST_F(FetcherTest, StatusIsReported) {
  HttpServer server([](const auto&) { return Answer("", "", "404 Not Found"); });
  Fetcher fetcher(WithClock());
  EXPECT_EQ(fetcher.Fetch(For(server.Url("/a"))).error().http_status, 404);
}

TEST_F(FetcherTest, AServerThatNeverAnswersIsLeft) {
  HttpServer server([](const auto&) { return std::string(); });
  Fetcher fetcher(WithClock());
  Request request = For(server.Url("/a"));
  request.timeout = std::chrono::milliseconds(100);
  EXPECT_EQ(fetcher.Fetch(request).error().code, vm::Errc::kTimeout);
}

TEST_F(FetcherTest, AnEndlessBodyIsCut) {
  HttpServer server([](const auto&) {
    return "HTTP/1.1 200 OK\r\nContent-Length: 4294967296\r\n\r\n" + std::string(300'000, 'x');
  });
  Options options = WithClock();
  options.max_bytes = 100'000;
  Fetcher fetcher(options);
  EXPECT_EQ(fetcher.Fetch(For(server.Url("/a"))).error().code, vm::Errc::kTooLong);
}

TEST_F(FetcherTest, OnlyAllowedPlacesAreFetched) {
  Options options = WithClock();
  options.allowed_roots = {"file:///nowhere/dialogs/"};
  Fetcher fetcher(options);
  EXPECT_EQ(fetcher.Fetch(For("file:///etc/hostname")).error().code, vm::Errc::kAccess);
  EXPECT_EQ(fetcher.Fetch(For("file:///nowhere/dialogs/../../etc/hostname")).error().code,
            vm::Errc::kAccess);
  EXPECT_EQ(fetcher.Fetch(For("file:///nowhere/dialogs/%2e%2e/x")).error().code, vm::Errc::kAccess);
  EXPECT_NE(fetcher.Fetch(For("file:///nowhere/dialogs/a")).error().code, vm::Errc::kAccess);
}

TEST_F(FetcherTest, DataUrisHoldTheirBytes) {
  Fetcher fetcher(WithClock());
  EXPECT_EQ(fetcher.Fetch(For("data:,a%20b"))->body, "a b");
  EXPECT_EQ(fetcher.Fetch(For("data:text/plain;base64,aGVsbG8="))->body, "hello");
}

Outcome RunMain(const std::string& body, const std::string& script,
                const std::vector<std::string>& expected) {
  Case made;
  made.name = "http";
  made.files["main.vxml"] = body;
  made.script = script;
  made.expected = expected;
  return RunCase(made);
}

constexpr const char* kDone =
    "<vxml version=\"2.1\"><form><block><exit expr=\"'pass'\"/></block></form></vxml>";

TEST(SubmitTest, GetPutsTheNamelistIntoTheQuery) {
  HttpServer server([](const auto&) { return Answer(kDone); });
  const auto outcome = RunMain(
      "<form><block><var name=\"a\" expr=\"'x y'\"/><var name=\"o\" "
      "expr=\"({p:1,q:{r:'\u3042'}})\"/>"
      "<submit next=\"" +
          server.Url("/s") + "\" namelist=\"a o\"/></block></form>",
      "", {});
  EXPECT_TRUE(outcome.pass) << outcome.why << outcome.transcript;
  ASSERT_EQ(server.requests().size(), 1U);
  EXPECT_EQ(server.requests()[0].target, "/s?a=x%20y&o.p=1&o.q.r=%E3%81%82");
}

TEST(SubmitTest, PostPutsItIntoTheBody) {
  HttpServer server([](const auto&) { return Answer(kDone); });
  const auto outcome =
      RunMain("<form><field name=\"f\" type=\"boolean\"/><block><submit method=\"post\" next=\"" +
                  server.Url("/s") + "\"/></block></form>",
              "say yes", {});
  EXPECT_TRUE(outcome.pass) << outcome.why;
  EXPECT_EQ(server.requests()[0].method, "POST");
  EXPECT_EQ(server.requests()[0].body, "f=true");
}

TEST(SubmitTest, MultipartIsSentInParts) {
  HttpServer server([](const auto&) { return Answer(kDone); });
  const auto outcome = RunMain(
      "<form><block><var name=\"a\" expr=\"7\"/><submit method=\"post\" "
      "enctype=\"multipart/form-data\" "
      "namelist=\"a\" next=\"" +
          server.Url("/s") + "\"/></block></form>",
      "", {});
  EXPECT_TRUE(outcome.pass) << outcome.why;
  EXPECT_NE(server.requests()[0].body.find("name=\"a\"\r\n\r\n7"), std::string::npos);
}

TEST(HttpEventTest, TheStatusIsInTheEvent) {
  HttpServer server([](const auto&) { return Answer("", "", "404 Not Found"); });
  const auto outcome = RunMain(
      "<form><catch event=\"error.badfetch.http.404\"><pass/></catch><block>"
      "<goto next=\"" +
          server.Url("/none") + "\"/></block></form>",
      "", {});
  EXPECT_TRUE(outcome.pass) << outcome.why << outcome.transcript;
}

TEST(HttpEventTest, FetchtimeoutIsBadfetch) {
  HttpServer server([](const auto&) { return std::string(); });
  const auto outcome = RunMain(
      "<form><catch event=\"error.badfetch\"><pass/></catch><block>"
      "<goto fetchtimeout=\"100ms\" next=\"" +
          server.Url("/") + "\"/></block></form>",
      "", {});
  EXPECT_TRUE(outcome.pass) << outcome.why << outcome.transcript;
}

TEST(HttpEventTest, DocumentsInShiftJisAreReadByTheirHeader) {
  HttpServer server([](const auto&) {
    return Answer(
        "<?xml version=\"1.0\"?><vxml version=\"2.0\"><form><block>\x82\xa0</block></form></vxml>",
        "Content-Type: application/voicexml+xml; charset=Shift_JIS\r\n");
  });
  const auto outcome =
      RunMain("<form><block><goto next=\"" + server.Url("/") + "\"/></block></form>", "",
              {"prompts: \u3042"});
  EXPECT_TRUE(outcome.pass) << outcome.why << outcome.transcript;
}

}  // namespace
}  // namespace vxml_test
