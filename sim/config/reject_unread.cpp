// Finds keys that nobody asked for: a misspelt key must not pass as its default.
#include <algorithm>
#include <numeric>
#include <vector>

#include "sim/base/error.h"
#include "sim/config/config_document.h"

namespace sunfleck {
namespace {

// Levenshtein distance: the least number of inserted, deleted or replaced characters.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row[b.size()];
}

template <class Names>
std::string nearest(const std::string& key, const Names& known) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, key.size() / 2) + 1;
  for (const std::string& name : known) {
    const std::size_t distance = edit_distance(key, name);
    if (distance < best_distance) best = name, best_distance = distance;
  }
  return best;
}

}  // namespace

void ConfigTable::Node::throw_unknown(const std::string& key, const toml::node& node) const {
  const auto& known = document->asked[table];
  std::string all;
  for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
  const std::string suggestion = nearest(key, known);
  const std::string remedy = (suggestion.empty() ? "" : "did you mean '" + suggestion + "'? ") +
                             (all.empty() ? "no key is known here" : "known here: " + all);
  throw_invalid(where_node(dotted(key), node), "unknown key '" + key + "'", remedy);
}

void ConfigTable::Node::reject_unread_below(const toml::node& node, const std::string& dotted_path) const {
  if (const toml::table* below = node.as_table()) {
    Node(document, below, dotted_path).reject_unread();
  } else if (const toml::array* items = node.as_array()) {
    for (std::size_t i = 0; i < items->size(); ++i)
      if (document->asked.contains((*items)[i].as_table()))
        reject_unread_below((*items)[i], dotted_path + "[" + std::to_string(i) + "]");
  }
}

void ConfigTable::Node::reject_unread() const {
  // Document order, so that the message names the first offender in the file.
  std::vector<std::pair<std::string, const toml::node*>> entries;
  for (const auto& [key, value] : *table) entries.emplace_back(std::string(key.str()), &value);
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return a.second->source().begin.line < b.second->source().begin.line;
  });
  for (const auto& [key, value] : entries) {
    if (!document->read.contains(value)) throw_unknown(key, *value);
    reject_unread_below(*value, dotted(key));
  }
}

}  // namespace sunfleck
