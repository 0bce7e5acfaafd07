// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pendulum/batch/fit_store.h"
#include "pendulum/service/fitting_service.h"
#include "tests/batch/small_batch.h"

/// A fitting service that tests call without a socket.
namespace pendulum::asked_service {

using Json = nlohmann::ordered_json;
using Fields = std::vector<HttpField>;

inline std::string FileText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::string FieldOf(const HttpResponse& response, const std::string& name) {
  const auto found = std::ranges::find(response.fields, name, &HttpField::name);
  return found == response.fields.end() ? "" : found->value;
}

/// "404 the sentence" for a problem, otherwise the status alone.
inline std::string AnswerOf(const HttpResponse& response) {
  const std::string status = std::to_string(response.status);
  if (FieldOf(response, "Content-Type") != "application/problem+json") return status;
  const Json problem = Json::parse(response.body);
  EXPECT_EQ(problem["status"], response.status);
  return status + " " + problem["detail"].get<std::string>();
}

/// A short recording that is fitted in a few hundredths of a second.
inline const std::string& Recording() {
  static const std::string text = small_batch::RecordingText(1);
  return text;
}

/// A pendulum at rest, which no model fits.
inline std::string RestingRecording() {
  std::string text = "time_s,angle_rad\n";
  for (int i = 0; i < 100; ++i) text += std::to_string(i) + ",0.25\n";
  return text;
}

inline constexpr const char* kForm = "multipart/form-data; boundary=X";

inline std::string PartOf(const std::string& name, const std::string& content, const std::string& filename = "") {
  return "--X\r\nContent-Disposition: form-data; name=\"" + name + "\"" +
         (filename.empty() ? "" : "; filename=\"" + filename + "\"") + "\r\n\r\n" + content + "\r\n";
}

inline std::string FormOf(const std::string& parts) { return parts + "--X--\r\n"; }

/// A service with a store in its own folder.
class ServiceTest : public testing::Test {
 protected:
  ServiceTest() {
    options_.threads = 1;
    options_.fit_time = std::chrono::minutes(10);
  }

  FittingService& Service() {
    if (!service_) Begin();
    return *service_;
  }

  void Begin() {
    auto store = FitStore::Open(folder_ / "fits.sqlite");
    ASSERT_TRUE(store) << store.error().message();
    auto service = FittingService::Begin(options_, *std::move(store));
    ASSERT_TRUE(service) << service.error().message();
    service_ = *std::move(service);
  }

  void End() { service_.reset(); }

  HttpResponse Ask(const std::string& method, const std::string& target, Fields fields = {}, std::string body = "") {
    if (std::ranges::find(fields, "Host", &HttpField::name) == fields.end()) fields.push_back({"Host", "localhost"});
    return Service().Handle({method, target, std::move(fields), std::move(body)});
  }

  HttpResponse Get(const std::string& target) { return Ask("GET", target); }

  HttpResponse Post(const std::string& target, const std::string& type, std::string body, Fields fields = {}) {
    fields.push_back({"Content-Type", type});
    return Ask("POST", target, std::move(fields), std::move(body));
  }

  Json JsonAt(const std::string& target) {
    const HttpResponse response = Get(target);
    EXPECT_EQ(response.status, 200) << target << ": " << response.body;
    EXPECT_EQ(FieldOf(response, "Content-Type"), "application/json");
    return Json::parse(response.body);
  }

  /// Posts a recording and returns the location of its fit.
  std::string Fitted(const std::string& query = "?model=viscous") {
    const HttpResponse response = Post("/v1/fits" + query, "text/csv", Recording());
    EXPECT_EQ(response.status, 200) << response.body;
    return FieldOf(response, "Location");
  }

  std::vector<std::string> IdsAt(const std::string& target, const std::string& list = "fits") {
    std::vector<std::string> ids;
    const Json json = JsonAt(target);
    for (const Json& item : json[list]) ids.push_back(item["id"]);
    return ids;
  }

  const small_batch::Folder folder_{"fitting_service"};
  ServiceOptions options_;

 private:
  std::unique_ptr<FittingService> service_;
};

inline std::string IdOf(const std::string& location) { return location.substr(location.rfind('/') + 1); }

}  // namespace pendulum::asked_service
