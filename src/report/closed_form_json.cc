// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/closed_form_json.h"

#include <vector>

#include "pendulum/report/closed_form_quantities.h"
#include "pendulum/report/json_parts.h"

namespace pendulum {
namespace {

using Json = nlohmann::ordered_json;

Json EstimateJson(const ReportedEstimate& reported) {
  return NumberObject()
      .Set("estimate", reported.estimate.value)
      .Set("std_error", reported.estimate.std_error)
      .Set("unit", Json(reported.unit))
      .Done();
}

Json EstimatesJson(const std::vector<ReportedEstimate>& estimates) {
  Json json = Json::object();
  for (const ReportedEstimate& reported : estimates) json[reported.name] = EstimateJson(reported);
  return json;
}

Json LinearJson(const LogDecrement& linear, Gravity gravity, const std::optional<Rig>& rig) {
  Json json = EstimatesJson(LinearEstimates(linear, gravity, rig));
  json["periods"] = linear.periods;
  return json;
}

Json DecrementJson(const TurningPointFit& decrement, const std::string& unit, const std::optional<Rig>& rig) {
  return NumberObject()
      .Set("parameters", EstimatesJson(DecrementEstimates(decrement, unit, rig)))
      .Set("chi_square", decrement.chi_square)
      .Set("dof", Json(decrement.freedom))
      .Set("p", decrement.Probability())
      .Done();
}

Json EnvelopesJson(const std::vector<EnvelopeLaw>& laws) {
  Json json = Json::array();
  for (const EnvelopeLaw& law : laws) {
    json.push_back(NumberObject()
                       .Set("term", Json(law.term))
                       .Set("shape", Json(law.shape))
                       .Set("chi_square", law.chi_square)
                       .Set("dof", Json(law.freedom))
                       .Set("p", law.probability)
                       .Done());
  }
  return json;
}

Json RowJson(const ClosedFormRow& row) {
  const std::string missing = row.why.empty() ? "there is no error to compare with" : row.why;
  NumberObject object;
  object.AddReason(row.why);
  return object.Set("quantity", Json(row.quantity))
      .Set("method", Json(row.method))
      .Set("closed_form", row.closed_form)
      .Set("std_error", row.std_error, missing)
      .Set("fit", row.fit)
      .Set("fit_std_error", row.fit_std_error, missing)
      .Set("unit", Json(row.unit))
      .Set("z", row.z, missing)
      .Set("agrees", row.agrees ? Json(*row.agrees) : Json(nullptr))
      .Set("reason", Json(nullptr))  // Done() writes the reasons here if there are any
      .Done();
}

/// std::nullopt for 0, which means unknown.
std::optional<double> NonzeroOrNull(double value) { return value > 0 ? std::optional(value) : std::nullopt; }

}  // namespace

nlohmann::ordered_json SamplingJson(const std::optional<Sampling>& sampling) {
  if (!sampling) return nullptr;
  const std::string no_frequency = "neither turning points nor a rig determine the frequency of the swing";
  const std::string no_counts = "the readings show no discrete levels";
  return NumberObject()
      .Set("rate_hz", sampling->rate_hz)
      .Set("jitter_s", sampling->jitter)
      .Set("gaps", Json(sampling->gaps))
      .Set("longest_gap_s", sampling->longest_gap)
      .Set("frequency_hz", NonzeroOrNull(sampling->frequency_hz), no_frequency)
      .Set("apparent_frequency_hz", NumberOrNull(sampling->apparent_frequency_hz))
      .Set("expected_frequency_hz", NumberOrNull(sampling->expected_frequency_hz))
      .Set("samples_per_period", NonzeroOrNull(sampling->samples_per_period), no_frequency)
      .Set("nyquist_margin", NonzeroOrNull(sampling->nyquist_margin), no_frequency)
      .Set("start_counts", NonzeroOrNull(sampling->start_counts), no_counts)
      .Set("end_counts", NonzeroOrNull(sampling->end_counts), no_counts)
      .Set("saturated_samples", Json(sampling->saturated))
      .Done();
}

nlohmann::ordered_json CheckJson(const ClosedFormCheck* check) {
  Json rows = Json::array();
  if (check == nullptr) return rows;
  for (const ClosedFormRow& row : check->rows) rows.push_back(RowJson(row));
  return rows;
}

nlohmann::ordered_json ClosedFormsJson(const IdentifiedRecording& recording, const std::optional<Rig>& si_rig) {
  if (!recording.closed_forms) return nullptr;
  const ClosedForms& forms = *recording.closed_forms;
  const std::string& unit = recording.data.unit;
  NumberObject json;
  json.Set("model", Json(recording.closed_forms_model));
  json.Set("linear", forms.linear ? LinearJson(*forms.linear, forms.gravity, si_rig) : Json(nullptr));
  if (!forms.linear) json.AddReason("linear: no two successive turning points are a whole period apart");
  json.Set("decrement", forms.decrement ? DecrementJson(*forms.decrement, unit, si_rig) : Json(nullptr));
  if (!forms.decrement) json.AddReason("decrement: " + forms.no_decrement);
  return json.Set("envelopes", EnvelopesJson(forms.envelopes))
      .Set("envelope", TextOrNull(forms.envelope))
      .Set("turning_points", Json(forms.table.points.size()))
      .Set(KeyWithUnit("noise", unit), forms.table.noise)
      .Done();
}

}  // namespace pendulum
