// What stands behind a ConfigTable: the parsed document and the record of who asked for what. Private to
// sim/config, because it shows toml++.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <unordered_set>

#include "sim/config/config_table.h"

namespace sunfleck {

struct ConfigTable::Document {
  std::string name;                 // as it appears in messages
  std::filesystem::path directory;  // empty for text
  toml::table root;
  std::unordered_set<const toml::node*> read;
  // Keys that the program knows in a table, present or not: what a misspelt one is compared with.
  std::map<const toml::table*, std::set<std::string, std::less<>>> asked;
};

struct ConfigTable::Node {
  std::shared_ptr<Document> document;
  const toml::table* table;
  std::string path;  // dotted path of this table, empty for the root

  Node(std::shared_ptr<Document> from, const toml::table* at, std::string dotted_path)
      : document(std::move(from)), table(at), path(std::move(dotted_path)) {}

  std::string dotted(std::string_view key) const {
    return path.empty() ? std::string(key) : path + "." + std::string(key);
  }
  std::string where_node(const std::string& dotted_path, const toml::node& node) const;
  std::string where_item(std::string_view key, std::size_t index, const toml::node& item) const;

  void ask(std::string_view key) const { document->asked[table].emplace(key); }
  // Marks the key as read; throws if it is absent.
  const toml::node& require(std::string_view key, const std::string& wanted) const;
  void reject_unread() const;
  void reject_unread_below(const toml::node& node, const std::string& dotted_path) const;
  [[noreturn]] void throw_unknown(const std::string& key, const toml::node& node) const;
};

}  // namespace sunfleck
