// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/export.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/batch/example_runs.h"

namespace pendulum::export_test {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;
using example_runs::RefittedOutcome;
using example_runs::SourceOf;
using example_runs::StoreOf;
using example_runs::UnfittedOutcome;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

using Row = std::map<std::string, std::string>;  // fields by column name

/// Parses CSV by RFC 4180, character by character.
std::vector<std::vector<std::string>> Rfc4180Rows(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row = {""};
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' && quoted && i + 1 < text.size() && text[i + 1] == '"') {
      row.back() += text[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (quoted || (c != ',' && c != '\n')) {
      row.back() += c;
    } else if (c == ',') {
      row.emplace_back();
    } else {
      rows.push_back(row);
      row = {""};
    }
  }
  EXPECT_FALSE(quoted);
  EXPECT_THAT(row, ElementsAre(""));  // the last row ends with a line end
  return rows;
}

class ExportTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  Store Make(const std::vector<ManifestEntry>& entries) const {
    return StoreOf(folder_ / "results.sqlite", SourceOf(entries));
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / ("export_test_" + std::to_string(getpid()));
};

ManifestEntry EntryOf(const std::string& id, const Json& columns = Json::object()) {
  ManifestEntry entry;
  entry.id = id;
  entry.path = "runs/" + id + ".csv";
  entry.columns = columns.dump();
  return entry;
}

std::vector<Json> LinesOf(Store& store) {
  std::string text;
  const auto exported = ExportJsonLines(store, [&](std::string_view piece) -> Result<void> {
    text += piece;
    return {};
  });
  EXPECT_TRUE(exported) << exported.error().message();
  std::vector<Json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(Json::parse(line));
  return lines;
}

std::string CsvOf(Store& store) {
  std::string text;
  const auto exported = ExportCsv(store, [&](std::string_view piece) -> Result<void> {
    text += piece;
    return {};
  });
  EXPECT_TRUE(exported) << exported.error().message();
  return text;
}

/// The rows of a store's CSV. Checks that each is as long as the header and that the column names are unique.
std::vector<Row> RowsOf(Store& store) {
  const auto rows = Rfc4180Rows(CsvOf(store));
  std::vector<Row> named;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].size(), rows[0].size());
    named.emplace_back();
    for (std::size_t k = 0; k < std::min(rows[i].size(), rows[0].size()); ++k) {
      EXPECT_TRUE(named.back().emplace(rows[0][k], rows[i][k]).second) << rows[0][k] << " occurs twice";
    }
  }
  return named;
}

/// Checks that a field is the shortest text of the double, so that it reads back exactly.
void ExpectNumber(const std::string& field, const Json& number, const std::string& name) {
  if (number.is_null()) {
    EXPECT_EQ(field, "") << name;
    return;
  }
  char* end = nullptr;
  EXPECT_EQ(std::strtod(field.c_str(), &end), number.get<double>()) << name;
  EXPECT_EQ(*end, '\0') << name;
  EXPECT_NE(field, "") << name;
}

// ---- JSON lines ----------------------------------------------------------------------------------------------------

TEST_F(ExportTest, WritesOneResultPerLine) {
  ManifestEntry first = EntryOf("a", {{"temperature", "21"}, {"note", "line\nline"}});
  first.rig = "rig.json";
  first.from = 0.1;
  Store store = Make({first, EntryOf("b"), EntryOf("c")});
  ASSERT_TRUE(store.Put("b", RefittedOutcome()) && store.Put("a", RefittedOutcome()));
  const auto lines = LinesOf(store);
  ASSERT_EQ(lines.size(), 2);  // c was not refitted
  EXPECT_EQ(lines[0]["id"], "a");
  EXPECT_EQ(
      lines[0]["manifest"],
      Json::parse(R"({"path":"runs/a.csv","rig":"rig.json","from_s":0.1,"temperature":"21","note":"line\nline"})"));
  EXPECT_EQ(lines[0]["result"].dump(), RefittedOutcome().result.dump());
  EXPECT_FALSE(lines[0].contains("error"));
  EXPECT_EQ(lines[1]["id"], "b");
  EXPECT_EQ(lines[1]["manifest"], Json::parse(R"({"path":"runs/b.csv"})"));
}

TEST_F(ExportTest, ContainsTheErrorOfARunWithoutAResult) {
  Store store = Make({EntryOf("a")});
  ASSERT_TRUE(store.Put("a", UnfittedOutcome()));
  const auto lines = LinesOf(store);
  ASSERT_EQ(lines.size(), 1);
  EXPECT_TRUE(lines[0]["result"].is_null());
  EXPECT_EQ(lines[0]["error"], Json({{"exit_code", 3}, {"message", UnfittedOutcome().reason.text()}}));
}

TEST_F(ExportTest, SaysWhichFitsAreStale) {
  Store store = Make({EntryOf("a"), EntryOf("b"), EntryOf("c")});
  RunOutcome fewer = RefittedOutcome();
  fewer.result["fits"].erase(1);  // coulomb
  fewer.result["recordings"][0]["fits"].erase(1);
  ASSERT_TRUE(store.Put("a", RefittedOutcome()) && store.Put("a", fewer) && store.Put("b", RefittedOutcome()) &&
              store.Put("c", RefittedOutcome()));
  store.database().exec(
      "UPDATE runs SET stale = 'it is gone' WHERE id = 'b'; UPDATE runs SET position = -1 WHERE id = 'c'");
  std::map<std::string, std::string> stale;
  for (const Row& row : RowsOf(store)) stale[row.at("id") + " " + row.at("model")] = row.at("stale");
  const std::string unlisted = "not among the recordings of the last refit";
  EXPECT_THAT(stale, testing::UnorderedElementsAre(
                         testing::Pair("a viscous", ""),
                         testing::Pair("a coulomb", "the last refit did not ask for this model"),
                         testing::Pair("b viscous", "it is gone"), testing::Pair("b coulomb", "it is gone"),
                         testing::Pair("c viscous", unlisted), testing::Pair("c coulomb", unlisted)));
  const auto lines = LinesOf(store);
  ASSERT_EQ(lines.size(), 3);
  EXPECT_EQ(lines[0]["stale"], unlisted);  // position -1
  EXPECT_FALSE(lines[1].contains("stale"));
  const Json& former = RefittedOutcome().result;
  Json coulomb = former["fits"][1];
  coulomb["recordings"] = Json::array({former["recordings"][0]["fits"][1]});
  EXPECT_EQ(lines[1]["former_fits"], Json::array({coulomb}));
  EXPECT_EQ(lines[2]["stale"], "it is gone");
  EXPECT_FALSE(lines[2].contains("former_fits"));
}

TEST_F(ExportTest, StopsIfTheSinkReturnsAnError) {
  Store store = Make({EntryOf("a"), EntryOf("b")});
  ASSERT_TRUE(store.Put("a", UnfittedOutcome()) && store.Put("b", UnfittedOutcome()));
  for (const auto& write : {ExportJsonLines, ExportCsv}) {
    int pieces = 0;
    const auto exported = write(store, [&](std::string_view) -> Result<void> {
      ++pieces;
      return Error(StatusCode::kCannotWrite, "full");
    });
    ASSERT_FALSE(exported);
    EXPECT_EQ(exported.error().code, StatusCode::kCannotWrite);
    EXPECT_EQ(exported.error().message(), "full");
    EXPECT_EQ(pieces, 1);
  }
}

TEST_F(ExportTest, ReportsADamagedStore) {
  Store store = Make({EntryOf("a")});
  ASSERT_TRUE(store.Put("a", UnfittedOutcome()));
  store.database().exec("UPDATE runs SET columns = 'no JSON'");
  const auto exported = ExportJsonLines(store, [](std::string_view) -> Result<void> { return {}; });
  ASSERT_FALSE(exported);
  EXPECT_EQ(exported.error().code, StatusCode::kDataLoss);
  EXPECT_THAT(exported.error().message(), StartsWith(store.name() + ": the file is damaged ("));
}

// ---- CSV -----------------------------------------------------------------------------------------------------------

TEST_F(ExportTest, WritesNumbersThatReadBackExactly) {
  Store store = Make({EntryOf("a")});
  ASSERT_TRUE(store.Put("a", RefittedOutcome()));
  const auto rows = RowsOf(store);
  ASSERT_EQ(rows.size(), 2);
  const Json& result = RefittedOutcome().result;
  for (std::size_t m = 0; m < result["fits"].size(); ++m) {
    const Json &fit = result["fits"][m], &own = result["recordings"][0]["fits"][m];
    const auto found = std::ranges::find_if(rows, [&](const Row& row) { return fit["model"] == row.at("model"); });
    ASSERT_NE(found, rows.end());
    EXPECT_EQ(fit["status"], found->at("status"));
    EXPECT_EQ(fit["reason"], found->at("reason"));
    ExpectNumber(found->at("aicc"), own["statistics"]["aicc"], "aicc");
    ExpectNumber(found->at("rms_residual"), own["statistics"]["rms_residual_rad"], "rms_residual");
    ExpectNumber(found->at("sigma"), own["noise"]["sigma_rad"], "sigma");
    for (const Json* const kind : {&fit["parameters"], &own["parameters"], &fit["derived"]}) {
      for (const auto& [name, value] : kind->items()) {
        ExpectNumber(found->at(name), value["estimate"], name);
        ExpectNumber(found->at(name + "_std_error"), value["std_error"], name);
        EXPECT_EQ(value["unit"], found->at(name + "_unit"));
        if (!value["interval95"].is_array()) continue;
        ExpectNumber(found->at(name + "_lower95"), value["interval95"][0], name);
        ExpectNumber(found->at(name + "_upper95"), value["interval95"][1], name);
      }
    }
  }
  EXPECT_EQ(rows[0].at("model"), "coulomb");
  EXPECT_EQ(rows[0].at("recommended") == "1", RefittedOutcome().result["comparison"]["recommended"] == "coulomb");
  EXPECT_EQ(rows[1].at("coulomb"), "");  // model viscous has no such parameter
  EXPECT_EQ(rows[1].at("coulomb_unit"), "");
}

TEST_F(ExportTest, WritesFailedRunsToo) {
  Store store = Make({EntryOf("a"), EntryOf("b"), EntryOf("pending")});
  ASSERT_TRUE(store.Put("a", UnfittedOutcome()) && store.Put("b", RefittedOutcome()));
  const auto rows = RowsOf(store);
  ASSERT_EQ(rows.size(), 4);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(rows[i].at("id"), "a");
    EXPECT_EQ(rows[i].at("status"), "failed");
    EXPECT_EQ(rows[i].at("reason"), UnfittedOutcome().reason.text());
    EXPECT_EQ(rows[i].at("inertia") + rows[i].at("inertia_unit") + rows[i].at("aicc"), "");
  }
}

TEST_F(ExportTest, WritesOnlyAHeaderWithoutRefittedRuns) {
  Store store = Make({EntryOf("a", {{"x", "1"}})});
  EXPECT_THAT(RowsOf(store), IsEmpty());
  EXPECT_THAT(Rfc4180Rows(CsvOf(store)), ElementsAre(Contains("x")));
}

TEST_F(ExportTest, KeepsTheColumnsOfTheManifest) {
  Store store = Make({EntryOf("a", {{"temperature", "21,5"}, {"a \"b\"\nc,d", "x"}}), EntryOf("b", {{"Öl", "π"}})});
  ASSERT_TRUE(store.Put("a", UnfittedOutcome()) && store.Put("b", UnfittedOutcome()));
  const auto rows = RowsOf(store);
  ASSERT_EQ(rows.size(), 4);
  EXPECT_EQ(rows[0].at("temperature"), "21,5");
  EXPECT_EQ(rows[0].at("a \"b\"\nc,d"), "x");
  EXPECT_EQ(rows[0].at("Öl"), "");
  EXPECT_EQ(rows[2].at("temperature"), "");
  EXPECT_EQ(rows[2].at("Öl"), "π");
}

TEST_F(ExportTest, PrefixesManifestColumnsWithTakenNames) {
  Store store = Make({EntryOf("a", {{"model", "m"}, {"inertia", "i"}, {"inertia_unit", "u"}, {"status", "s"}})});
  ASSERT_TRUE(store.Put("a", RefittedOutcome()));
  const auto rows = RowsOf(store);
  ASSERT_EQ(rows.size(), 2);
  EXPECT_EQ(rows[0].at("manifest_model"), "m");
  EXPECT_EQ(rows[0].at("manifest_inertia"), "i");
  EXPECT_EQ(rows[0].at("manifest_inertia_unit"), "u");
  EXPECT_EQ(rows[0].at("manifest_status"), "s");
  EXPECT_EQ(rows[0].at("model"), "coulomb");
}

TEST_F(ExportTest, PrefixesAgainIfThePrefixedNameIsTaken) {
  Store store = Make({EntryOf("a", {{"manifest_model", "first"}, {"model", "second"}})});
  ASSERT_TRUE(store.Put("a", RefittedOutcome()));
  const auto rows = RowsOf(store);
  ASSERT_EQ(rows.size(), 2);
  EXPECT_EQ(rows[0].at("manifest_model"), "first");
  EXPECT_EQ(rows[0].at("manifest_manifest_model"), "second");
}

TEST_F(ExportTest, NamesRigAndCalibrationOfEachRun) {
  ManifestEntry entry = EntryOf("a");
  entry.rig = "rigs/left.json";
  Store store = Make({entry, EntryOf("b")});
  ASSERT_TRUE(store.Put("a", RefittedOutcome()) && store.Put("b", UnfittedOutcome()));
  EXPECT_THAT(CsvOf(store), StartsWith("id,path,rig,calibration,model,recommended,"));
  const auto rows = RowsOf(store);
  ASSERT_EQ(rows.size(), 4);
  EXPECT_EQ(rows[0].at("path"), "runs/a.csv");
  EXPECT_EQ(rows[0].at("rig"), "rigs/left.json");
  EXPECT_EQ(rows[2].at("rig") + rows[2].at("calibration"), "");
}

TEST_F(ExportTest, WritesIdsWithAnyCharacters) {
  const std::vector<std::string> ids = {"a,\"b\"",    "line\nline", "cr\r\nlf", " blank ", "\ttab",
                                        "semi;colon", "π 振り子",   "\"",       ",",       "\"\"",
                                        "\\",         "'",          "=1+1",     "#"};
  std::vector<ManifestEntry> entries;
  for (const std::string& id : ids) entries.push_back(EntryOf(id));
  Store store = Make(entries);
  for (const std::string& id : ids) ASSERT_TRUE(store.Put(id, UnfittedOutcome()));
  const auto rows = RowsOf(store);
  const auto lines = LinesOf(store);
  ASSERT_EQ(rows.size(), 2 * ids.size());
  ASSERT_EQ(lines.size(), ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    EXPECT_EQ(rows[2 * i].at("id"), ids[i]);
    EXPECT_EQ(rows[2 * i].at("path"), "runs/" + ids[i] + ".csv");
    EXPECT_EQ(lines[i]["id"], ids[i]);
  }
}

// RFC 4180, section 2, rules 5 to 7.
TEST(CsvField, QuotesFieldsThatNeedIt) {
  EXPECT_EQ(CsvField(""), "");
  EXPECT_EQ(CsvField("a b"), "a b");
  EXPECT_EQ(CsvField("a,b"), "\"a,b\"");
  EXPECT_EQ(CsvField("a\"b"), "\"a\"\"b\"");
  EXPECT_EQ(CsvField("a\nb"), "\"a\nb\"");
  EXPECT_EQ(CsvField("a\r"), "\"a\r\"");
  EXPECT_EQ(CsvField(" a"), "\" a\"");
  EXPECT_EQ(CsvField("\""), "\"\"\"\"");
  EXPECT_EQ(CsvField("-1.5e-7"), "-1.5e-7");
}

}  // namespace
}  // namespace pendulum::export_test
