// ConfigTable over toml++: where values are looked up and checked. Bookkeeping of what was read lives in
// config_document.h, the search for unread keys in reject_unread.cpp.
#include "sim/config/config_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "sim/base/error.h"
#include "sim/config/config_document.h"

namespace sunfleck {
namespace {

std::string printed(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.10g", value);
  return buffer;
}

std::string described(Range range) {
  const bool below = range.lo > std::numeric_limits<double>::lowest();
  const bool above = range.hi < std::numeric_limits<double>::max();
  if (below && above) return "a number from " + printed(range.lo) + " to " + printed(range.hi);
  if (below) return "a number of at least " + printed(range.lo);
  if (above) return "a number of at most " + printed(range.hi);
  return "a finite number";
}

std::string type_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a floating-point number";
    case toml::node_type::boolean:
      return "a boolean";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::table:
      return "a table";
    default:
      return "a date or time";
  }
}

[[noreturn]] void throw_wrong_type(const std::string& where, const toml::node& node,
                                   const std::string& wanted) {
  throw_invalid(where, "is " + type_of(node), "give " + wanted);
}

double checked_number(const std::string& where, const toml::node& node, Range range) {
  if (!node.is_number()) throw_wrong_type(where, node, described(range));
  const double value = *node.value<double>();
  if (!std::isfinite(value) || value < range.lo || value > range.hi)
    throw_invalid(where, printed(value) + " is not allowed", "give " + described(range));
  return value;
}

std::string list_of(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "\"" : ", \"") + word + "\"";
  return all;
}

std::string checked_choice(const std::string& where, std::string value,
                           const std::vector<std::string>& allowed) {
  if (std::find(allowed.begin(), allowed.end(), value) == allowed.end())
    throw_invalid(where, "\"" + value + "\" is not one of the choices", "give one of " + list_of(allowed));
  return value;
}

}  // namespace

ConfigTable::ConfigTable(std::unique_ptr<Node> node) : node_(std::move(node)) {}
ConfigTable::ConfigTable(ConfigTable&&) noexcept = default;
ConfigTable& ConfigTable::operator=(ConfigTable&&) noexcept = default;
ConfigTable::~ConfigTable() = default;

bool ConfigTable::has(std::string_view key) const {
  node_->ask(key);
  return node_->table->contains(key);
}

std::vector<std::string> ConfigTable::keys() const {
  std::vector<std::string> names;
  for (const auto& [key, value] : *node_->table) names.emplace_back(key.str());
  return names;
}

double ConfigTable::number(std::string_view key, Range range) const {
  return checked_number(where(key), node_->require(key, described(range)), range);
}

std::int64_t ConfigTable::integer(std::string_view key, Range range) const {
  const toml::node& node = node_->require(key, "an integer");
  if (!node.is_integer()) throw_wrong_type(where(key), node, "an integer without decimal point");
  checked_number(where(key), node, range);
  return *node.value<std::int64_t>();
}

std::string ConfigTable::text(std::string_view key) const {
  const toml::node& node = node_->require(key, "a text in quotes");
  if (!node.is_string()) throw_wrong_type(where(key), node, "a text in quotes");
  return *node.value<std::string>();
}

bool ConfigTable::boolean(std::string_view key) const {
  const toml::node& node = node_->require(key, "true or false");
  if (!node.is_boolean()) throw_wrong_type(where(key), node, "true or false");
  return *node.value<bool>();
}

std::vector<double> ConfigTable::numbers(std::string_view key, Range range) const {
  const toml::node& node = node_->require(key, "an array of numbers");
  if (!node.is_array()) throw_wrong_type(where(key), node, "an array, each " + described(range));
  std::vector<double> values;
  for (const toml::node& item : *node.as_array())
    values.push_back(checked_number(node_->where_item(key, values.size(), item), item, range));
  return values;
}

std::vector<std::string> ConfigTable::texts(std::string_view key) const {
  const toml::node& node = node_->require(key, "an array of texts");
  if (!node.is_array()) throw_wrong_type(where(key), node, "an array of texts in quotes");
  std::vector<std::string> values;
  for (const toml::node& item : *node.as_array()) {
    if (!item.is_string())
      throw_wrong_type(node_->where_item(key, values.size(), item), item, "a text in quotes");
    values.push_back(*item.value<std::string>());
  }
  return values;
}

ConfigTable ConfigTable::table(std::string_view key) const {
  const std::string wanted = "a table [" + node_->dotted(key) + "]";
  const toml::node& node = node_->require(key, wanted);
  if (!node.is_table()) throw_wrong_type(where(key), node, wanted);
  return ConfigTable(std::make_unique<Node>(node_->document, node.as_table(), node_->dotted(key)));
}

std::vector<ConfigTable> ConfigTable::tables(std::string_view key) const {
  std::vector<ConfigTable> all;
  if (!has(key)) return all;
  const std::string wanted = "an array of tables [[" + node_->dotted(key) + "]]";
  const toml::node& node = node_->require(key, wanted);
  if (!node.is_array()) throw_wrong_type(where(key), node, wanted);
  for (const toml::node& item : *node.as_array()) {
    if (!item.is_table()) throw_wrong_type(node_->where_item(key, all.size(), item), item, wanted);
    const std::string path = node_->dotted(key) + "[" + std::to_string(all.size()) + "]";
    all.push_back(ConfigTable(std::make_unique<Node>(node_->document, item.as_table(), path)));
  }
  return all;
}

double ConfigTable::number_or(std::string_view key, double fallback, Range range) const {
  return has(key) ? number(key, range) : fallback;
}

std::int64_t ConfigTable::integer_or(std::string_view key, std::int64_t fallback, Range range) const {
  return has(key) ? integer(key, range) : fallback;
}

std::string ConfigTable::text_or(std::string_view key, std::string fallback) const {
  return has(key) ? text(key) : std::move(fallback);
}

bool ConfigTable::boolean_or(std::string_view key, bool fallback) const {
  return has(key) ? boolean(key) : fallback;
}

std::optional<ConfigTable> ConfigTable::table_if(std::string_view key) const {
  if (!has(key)) return std::nullopt;
  return table(key);
}

std::string ConfigTable::choice(std::string_view key, const std::vector<std::string>& allowed) const {
  node_->require(key, "one of " + list_of(allowed));
  return checked_choice(where(key), text(key), allowed);
}

std::string ConfigTable::choice_or(std::string_view key, std::string fallback,
                                   const std::vector<std::string>& allowed) const {
  return has(key) ? choice(key, allowed) : std::move(fallback);
}

std::string ConfigTable::where(std::string_view key) const {
  const toml::node* node = node_->table->get(key);
  return node_->where_node(node_->dotted(key), node ? *node : *node_->table);
}

std::filesystem::path ConfigTable::directory() const { return node_->document->directory; }

void ConfigTable::reject_unread() const { node_->reject_unread(); }

}  // namespace sunfleck
