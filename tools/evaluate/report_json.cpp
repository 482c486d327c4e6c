#include "tools/evaluate/report.hpp"
#include "tools/inspect/json_writer.hpp"

namespace linescope::evaluate {
namespace {

void add(JsonWriter& json, const char* key, const std::optional<Estimate>& e) {
  if (!e) return json.add_null(key);
  json.begin_object(key);
  json.add("mean", e->mean);
  json.add("half_width_95", e->half_width);
  json.add("deviation", e->deviation);
  json.add("count", e->count);
  json.end_object();
}

void add(JsonWriter& json, const Row& row) {
  json.begin_object();
  json.add("what", row.what);
  json.add("unit", row.unit);
  if (row.thesis)
    json.add("thesis", *row.thesis);
  else
    json.add_null("thesis");
  add(json, "thesis_algorithms", row.plain);
  add(json, "better_algorithms", row.better);
  if (const Agreement a = agreement(row); a != Agreement::not_comparable)
    json.add("thesis_within_prediction_interval", a == Agreement::could_be);
  json.end_object();
}

void add_texts(JsonWriter& json, const char* key, const std::vector<std::string>& texts) {
  json.begin_array(key);
  for (const std::string& text : texts) json.add({}, text);
  json.end_array();
}

}  // namespace

std::string as_json(const Report& report) {
  JsonWriter json;
  json.begin_object();
  json.add("title", report.title);
  json.add("caution", kCaution);
  add_texts(json, "setting", report.setting);
  json.begin_array("tables");
  for (const Section& section : report.sections) {
    json.begin_object();
    json.add("id", section.table.id);
    json.add("title", section.table.title);
    json.begin_array("rows");
    for (const Row& row : section.table.rows) add(json, row);
    json.end_array();
    add_texts(json, "notes", section.table.notes);
    json.end_object();
  }
  json.end_array();
  json.end_object();
  return json.text() + '\n';
}

}  // namespace linescope::evaluate
