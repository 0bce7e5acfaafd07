// SPDX-License-Identifier: Apache-2.0
// Tests of FittingService without a socket: batches and their events.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/asked_service.h"

extern "C" [[gnu::weak]] void __asan_init();  // from the address sanitizer's library; null without it

namespace pendulum::fitting_service_batches_test {
namespace {

using asked_service::AnswerOf;
using asked_service::FieldOf;
using asked_service::Fields;
using asked_service::FormOf;
using asked_service::IdOf;
using asked_service::Json;
using asked_service::kForm;
using asked_service::PartOf;
using asked_service::Recording;
using asked_service::RestingRecording;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::SizeIs;
using testing::StartsWith;

constexpr std::chrono::minutes kPatience{2};
constexpr std::chrono::milliseconds kStep{10};

/// An event of a stream: its name, number and data.
struct Event {
  std::string name, id;
  Json data;
};

/// The events of a complete text. An event has lines "field: value" and ends with an empty line (WHATWG HTML, 9.2.5).
std::vector<Event> EventsOf(const std::string& text) {
  std::vector<Event> events;
  Event event;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    if (line.empty()) events.push_back(std::exchange(event, {}));
    if (line.starts_with("event: ")) event.name = line.substr(7);
    if (line.starts_with("id: ")) event.id = line.substr(4);
    if (line.starts_with("data: ")) event.data = Json::parse(line.substr(6));
  }
  return events;
}

class FittingServiceBatchesTest : public asked_service::ServiceTest {
 protected:
  /// Recordings a.csv, rest.csv (which no model fits) and b.csv.
  static std::string ThreeRecordings() {
    return PartOf("data", Recording(), "a.csv") + PartOf("data", RestingRecording(), "rest.csv") +
           PartOf("data", small_batch::RecordingText(2), "b.csv");
  }

  std::string Sent(const std::string& parts) {
    const HttpResponse response = Post("/v1/batches?model=viscous", kForm, FormOf(parts));
    EXPECT_EQ(response.status, 202) << response.body;
    return FieldOf(response, "Location");
  }

  /// Waits until no run of the batch is left and returns the batch.
  Json Done(const std::string& location) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < end) {
      Json batch = JsonAt(location);
      if (batch["state"] == "done") return batch;
      std::this_thread::sleep_for(kStep);
    }
    ADD_FAILURE() << location << " is not done";
    return JsonAt(location);
  }

  /// All events up to the last one.
  std::vector<Event> Listened(const std::string& location, const Fields& fields = {}) {
    const HttpResponse response = Ask("GET", location + "/events", fields);
    EXPECT_EQ(response.status, 200) << response.body;
    std::string text;
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (response.events && std::chrono::steady_clock::now() < end) {
      const EventText next = response.events();
      text += next.text;
      if (next.is_last) return EventsOf(text);
      std::this_thread::sleep_for(kStep);
    }
    ADD_FAILURE() << "the events of " << location << " do not end";
    return {};
  }
};

// ---- Complete batches ----------------------------------------------------------------------------------------------

TEST_F(FittingServiceBatchesTest, FitsAllRunsInTheOrderSent) {
  const HttpResponse response = Post("/v1/batches?model=viscous", kForm, FormOf(ThreeRecordings()));
  ASSERT_EQ(response.status, 202) << response.body;
  const std::string location = FieldOf(response, "Location");
  EXPECT_THAT(location, MatchesRegex("/v1/batches/[0-9a-f]{24}"));
  const Json accepted = Json::parse(response.body);
  EXPECT_EQ(accepted["id"], IdOf(location));
  EXPECT_EQ(accepted["runs"], 3);
  const Json batch = Done(location);
  EXPECT_EQ(batch["done"], 3);
  EXPECT_EQ(batch["failed"], 1);
  EXPECT_EQ(batch["created"], accepted["created"]);
  ASSERT_EQ(batch["fits"].size(), 3U);
  const std::vector<std::string> names = {"a.csv", "rest.csv", "b.csv"};
  const std::vector<int> exit_codes = {0, 5, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const Json& fit = batch["fits"][i];
    EXPECT_EQ(fit["name"], names[i]);
    EXPECT_EQ(fit["exit_code"], exit_codes[i]);
    EXPECT_EQ(fit["state"], "done");
    EXPECT_EQ(fit["id"], accepted["fits"][i]["id"]);
  }
  EXPECT_EQ(batch["fits"][1]["reason"], "the reading is constant: no swing");
}

// The two recordings that are fitted have the same true inertia.
TEST_F(FittingServiceBatchesTest, SaysWhetherTheRecordingsAgree) {
  const std::string location = Sent(ThreeRecordings());
  Done(location);
  const Json agreement = JsonAt(location + "/agreement");
  EXPECT_EQ(agreement["law"], "viscous");
  EXPECT_EQ(agreement["level"], "good");
  EXPECT_THAT(agreement["text"].get<std::string>(), StartsWith("The 2 recordings agree under the law viscous (p "));
  ASSERT_EQ(agreement["means"].size(), 2U);
  EXPECT_EQ(agreement["means"][0]["name"], "inertia");
  EXPECT_EQ(agreement["means"][0]["recordings"], 2);
  EXPECT_THAT(agreement["means"][0]["text"].get<std::string>(), HasSubstr(" ± "));
  EXPECT_THAT(agreement["outliers"], IsEmpty());
  EXPECT_THAT(AnswerOf(Get("/v1/batches/000000000000000000000000/agreement")), StartsWith("404 "));
}

// The answer for a run of a batch equals the answer for a single fit.
TEST_F(FittingServiceBatchesTest, AnswersForEachRunAsForASingleFit) {
  const Json batch = Done(Sent(ThreeRecordings()));
  const auto fit = [&](std::size_t i) { return "/v1/fits/" + batch["fits"][i]["id"].get<std::string>(); };
  EXPECT_EQ(Get(fit(0)).body, Post("/v1/fits?model=viscous", "text/csv", Recording()).body);
  EXPECT_EQ(AnswerOf(Get(fit(1))), AnswerOf(Post("/v1/fits?model=viscous", "text/csv", RestingRecording())));
  EXPECT_EQ(Json::parse(Get(fit(1)).body)["code"], "no_swing");
  EXPECT_EQ(Get(fit(1) + "/report").status, 422);
  EXPECT_EQ(Get(fit(2) + "/report").status, 200);
  EXPECT_EQ(Get(fit(1) + "/recording").body, RestingRecording());
  EXPECT_EQ(JsonAt(fit(0) + "/request")["batch"], batch["id"]);
  EXPECT_THAT(IdsAt("/v1/fits?batch=" + batch["id"].get<std::string>()), SizeIs(3));
}

TEST_F(FittingServiceBatchesTest, ResumesAtTheNextStart) {
  const std::string location = Sent(ThreeRecordings() + ThreeRecordings());
  End();  // runs may be waiting, in progress or done
  const Json batch = Done(location);
  EXPECT_EQ(batch["runs"], 6);
  EXPECT_EQ(batch["done"], 6);
  EXPECT_EQ(batch["failed"], 2);
  End();
  EXPECT_EQ(Get(location).body, batch.dump(2) + "\n");
}

TEST_F(FittingServiceBatchesTest, KeepsABatchThatArrivesDuringAStop) {
  Service().Stop();  // no run is started
  const HttpResponse response = Post("/v1/batches?model=viscous", kForm, FormOf(ThreeRecordings()));
  ASSERT_EQ(response.status, 202) << response.body;
  const Json batch = Json::parse(response.body);
  EXPECT_EQ(batch["state"], "running");
  EXPECT_EQ(batch["fits"][0]["state"], "waiting");
  EXPECT_TRUE(batch["fits"][0]["exit_code"].is_null());
  const HttpResponse fit = Get("/v1/fits/" + batch["fits"][0]["id"].get<std::string>());
  EXPECT_THAT(AnswerOf(fit), StartsWith("409 "));
  EXPECT_FALSE(FieldOf(fit, "Retry-After").empty());
  EXPECT_EQ(AnswerOf(Get("/healthz")), "503");
  End();
  EXPECT_EQ(Done("/v1/batches/" + batch["id"].get<std::string>())["done"], 3);
}

TEST_F(FittingServiceBatchesTest, AcceptsABatchOncePerKey) {
  const Fields key = {{"Idempotency-Key", "k1"}};
  const HttpResponse first = Post("/v1/batches?model=viscous", kForm, FormOf(ThreeRecordings()), key);
  const HttpResponse again = Post("/v1/batches?model=viscous", kForm, FormOf(ThreeRecordings()), key);
  EXPECT_EQ(again.status, 202);
  EXPECT_EQ(FieldOf(again, "Location"), FieldOf(first, "Location"));
  EXPECT_EQ(FieldOf(again, "Idempotency-Replayed"), "true");
  EXPECT_THAT(IdsAt("/v1/batches", "batches"), SizeIs(1));
}

TEST_F(FittingServiceBatchesTest, ListsBatchesLatestFirst) {
  const std::string part = PartOf("data", Recording(), "a.csv");
  std::vector<std::string> ids;
  for (int i = 0; i < 3; ++i) ids.insert(ids.begin(), IdOf(Sent(part)));
  EXPECT_EQ(IdsAt("/v1/batches", "batches"), ids);
  const Json first = JsonAt("/v1/batches?limit=2");
  EXPECT_EQ(first["batches"].size(), 2U);
  EXPECT_THAT(IdsAt("/v1/batches?limit=2&before=" + first["next"].dump(), "batches"), ElementsAre(ids[2]));
  EXPECT_EQ(Json::parse(Get("/v1/batches").body)["batches"][0]["runs"], 1);
}

/// Largest memory of the process since ForgetMostMemory, in KiB.
std::int64_t MostMemory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::int64_t size = 0;
    if (word == "VmHWM:" && status >> size) return size;
  }
  return 0;
}

void ForgetMostMemory() { std::ofstream("/proc/self/clear_refs") << 5; }  // proc(5)

// Runs of a batch share one copy of the rig in memory.
TEST_F(FittingServiceBatchesTest, StoresASharedRigOnce) {
  constexpr std::size_t kRig = 60'000, kRuns = 3000;  // 170 MiB with a separate rig per run
  std::string parts = PartOf("rig", small_batch::kRigText + std::string(kRig, ' '));
  for (std::size_t i = 0; i < kRuns; ++i) parts += PartOf("data", "x", "a.csv");
  const std::int64_t most = 1024 * (__asan_init == nullptr ? 60 : 260);  // KiB; the sanitizer keeps freed memory
  Service().Stop();
  ForgetMostMemory();
  const std::int64_t before = MostMemory();
  ASSERT_EQ(Post("/v1/batches?model=viscous", kForm, FormOf(parts)).status, 202);
  EXPECT_GT(before, 0);
  EXPECT_LT(MostMemory() - before, most);
}

// ---- Deleting ------------------------------------------------------------------------------------------------------

TEST_F(FittingServiceBatchesTest, DeletesABatchWithItsFits) {
  const std::string location = Sent(ThreeRecordings());
  const Json batch = JsonAt(location);
  EXPECT_EQ(Ask("DELETE", location).status, 204);
  EXPECT_EQ(AnswerOf(Get(location)), "404 there is no batch " + IdOf(location) + "; it may have been deleted");
  EXPECT_EQ(Get(location + "/events").status, 404);
  EXPECT_EQ(Ask("DELETE", location).status, 404);
  for (const Json& fit : batch["fits"]) EXPECT_EQ(Get("/v1/fits/" + fit["id"].get<std::string>()).status, 404);
  EXPECT_THAT(IdsAt("/v1/fits"), IsEmpty());
  const std::string next = Sent(PartOf("data", Recording(), "a.csv"));
  EXPECT_EQ(Done(next)["done"], 1);  // the threads for batches still run
}

TEST_F(FittingServiceBatchesTest, EndsTheEventsOfADeletedBatch) {
  Service().Stop();
  const std::string location = Sent(ThreeRecordings());
  const HttpResponse response = Get(location + "/events");
  ASSERT_TRUE(response.events);
  EXPECT_FALSE(response.events().is_last);
  ASSERT_EQ(Ask("DELETE", location).status, 204);
  EXPECT_TRUE(response.events().is_last);
}

TEST_F(FittingServiceBatchesTest, SkipsARunDeletedSeparately) {
  Service().Stop();
  const std::string location = Sent(ThreeRecordings());
  const Json waiting = JsonAt(location);
  ASSERT_EQ(Ask("DELETE", "/v1/fits/" + waiting["fits"][1]["id"].get<std::string>()).status, 204);
  End();
  const Json batch = Done(location);
  EXPECT_EQ(batch["runs"], 2);
  EXPECT_EQ(batch["done"], 2);
  EXPECT_EQ(batch["failed"], 0);
}

TEST_F(FittingServiceBatchesTest, CancelsTheWaitingRunsAndKeepsTheOthers) {
  const std::string location = Sent(ThreeRecordings());
  Done(location);
  Service().Stop();
  const std::string other = Sent(ThreeRecordings());
  const HttpResponse events = Get(other + "/events");
  ASSERT_EQ(Ask("DELETE", other + "?keep=done").status, 204);
  EXPECT_EQ(JsonAt(other)["runs"], 0);
  EXPECT_EQ(JsonAt(other)["state"], "done");
  EXPECT_TRUE(events.events().is_last);
  ASSERT_EQ(Ask("DELETE", location + "?keep=done").status, 204);
  EXPECT_EQ(JsonAt(location)["done"], 3);
  EXPECT_EQ(AnswerOf(Ask("DELETE", location + "?keep=all")), "400 keep is 'all'; it must be done");
  EXPECT_EQ(AnswerOf(Ask("DELETE", "/v1/batches/none?keep=done")),
            "404 there is no batch none; it may have been deleted");
}

/// A bootstrap of all models with 60,000 samples that is not stopped takes minutes.
TEST_F(FittingServiceBatchesTest, StopsTheFitInProgressOfWhatIsDeleted) {
  SyntheticOptions minutes = small_batch::Truth(1);
  minutes.duration = 300;
  minutes.sample_rate = 200;
  const std::string part = PartOf("data", small_batch::RecordingText(minutes), "a.csv");
  for (const bool cancels : {false, true}) {
    const HttpResponse sent = Post("/v1/batches?model=all&interval=bootstrap", kForm, FormOf(part));
    ASSERT_EQ(sent.status, 202) << sent.body;
    ASSERT_EQ(Ask("DELETE", FieldOf(sent, "Location") + (cancels ? "?keep=done" : "")).status, 204);
    const std::string next = Sent(PartOf("data", Recording(), "b.csv"));  // there is only one thread
    EXPECT_EQ(Done(next)["done"], 1);
  }
}

// ---- Events --------------------------------------------------------------------------------------------------------

void ExpectAllEvents(const std::vector<Event>& events, const Json& batch) {
  ASSERT_EQ(events.size(), 4U);
  int failed = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Event& event = events[i];
    const Json& fit = batch["fits"][i];
    EXPECT_EQ(event.name, "fit");
    EXPECT_EQ(event.id, std::to_string(i + 1));
    EXPECT_EQ(event.data["id"], fit["id"]);
    EXPECT_EQ(event.data["name"], fit["name"]);
    EXPECT_EQ(event.data["exit_code"], fit["exit_code"]);
    EXPECT_EQ(event.data["reason"], fit["reason"]);
    failed += fit["reason"] == "" ? 0 : 1;
    EXPECT_EQ(event.data["failed"], failed);
    EXPECT_EQ(event.data["done"], i + 1);
    EXPECT_EQ(event.data["runs"], 3);
  }
  EXPECT_EQ(events[3].name, "done");
  EXPECT_EQ(events[3].data, (Json{{"runs", 3}, {"done", 3}, {"failed", 1}}));
}

TEST_F(FittingServiceBatchesTest, SendsAnEventPerFinishedRun) {
  const std::string location = Sent(ThreeRecordings());
  const auto events = Listened(location);
  ExpectAllEvents(events, JsonAt(location));
}

TEST_F(FittingServiceBatchesTest, SendsTheEventsOfAFinishedBatch) {
  const std::string location = Sent(ThreeRecordings());
  const Json batch = Done(location);
  ExpectAllEvents(Listened(location), batch);
  End();
  ExpectAllEvents(Listened(location), batch);
}

TEST_F(FittingServiceBatchesTest, ResumesAfterTheClientsLastEvent) {
  const std::string location = Sent(ThreeRecordings());
  Done(location);
  const auto events = Listened(location, {{"Last-Event-ID", "2"}});
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].id, "3");
  EXPECT_EQ(events[0].data["name"], "b.csv");
  EXPECT_EQ(events[0].data["failed"], 1);
  EXPECT_EQ(events[1].data["failed"], 1);
  for (const char* id : {"3", "4", "99999999999999999999999"}) {
    const auto rest = Listened(location, {{"Last-Event-ID", id}});
    ASSERT_FALSE(rest.empty()) << id;
    EXPECT_EQ(rest.back().name, "done") << id;
  }
  EXPECT_EQ(Listened(location, {{"Last-Event-ID", "-1"}}).size(), 4U);
  EXPECT_EQ(Listened(location, {{"Last-Event-ID", "none"}}).size(), 4U);
}

// While all runs wait, the stream has no events and does not end.
TEST_F(FittingServiceBatchesTest, SendsNoEventsForWaitingRuns) {
  Service().Stop();
  const std::string location = Sent(ThreeRecordings());
  const HttpResponse response = Get(location + "/events");
  ASSERT_TRUE(response.events);
  const EventText next = response.events();
  EXPECT_EQ(next.text, "");
  EXPECT_FALSE(next.is_last);
}

// ---- Limits --------------------------------------------------------------------------------------------------------

TEST_F(FittingServiceBatchesTest, LimitsTheNumberOfWaitingRuns) {
  options_.limits.max_runs = 4;
  Service().Stop();
  Sent(ThreeRecordings());
  const HttpResponse response = Post("/v1/batches?model=viscous", kForm, FormOf(ThreeRecordings()));
  EXPECT_EQ(AnswerOf(response), "429 3 recordings of batches wait already, but this service keeps 4 at most");
  EXPECT_FALSE(FieldOf(response, "Retry-After").empty());
  EXPECT_THAT(IdsAt("/v1/batches", "batches"), SizeIs(1));
  EXPECT_EQ(AnswerOf(Post("/v1/batches", kForm, FormOf(ThreeRecordings() + ThreeRecordings()))).substr(0, 3), "413");
}

TEST_F(FittingServiceBatchesTest, StopsARunThatTakesTooLongAndContinues) {
  SyntheticOptions minutes = small_batch::Truth(1);
  minutes.duration = 300;
  minutes.sample_rate = 200;  // a fit takes seconds on any machine
  options_.fit_time = std::chrono::milliseconds(1);
  const std::string location =
      Sent(PartOf("data", small_batch::RecordingText(minutes), "a.csv") + PartOf("data", RestingRecording(), "b"));
  const Json batch = Done(location);
  EXPECT_EQ(batch["failed"], 2);
  EXPECT_EQ(batch["fits"][0]["exit_code"], 75);
  const HttpResponse fit = Get("/v1/fits/" + batch["fits"][0]["id"].get<std::string>());
  EXPECT_THAT(AnswerOf(fit), StartsWith("408 the fit was not done after 0.004 s"))
      << "a run of a batch has four times the limit of a single fit";
}

}  // namespace
}  // namespace pendulum::fitting_service_batches_test
