// Reading a TOML file or text into a ConfigTable::Document, and its places in messages ("file:line: key").
#include "sim/config/config_document.h"

#include <fstream>
#include <sstream>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

std::string content_of(const std::filesystem::path& path) {
  if (std::error_code failed; std::filesystem::is_directory(path, failed))
    throw Error(ErrorKind::kNotFound, path.string(), "is a folder, not a file",
                "give the path of a TOML file in it");
  std::ifstream in(path, std::ios::binary);
  if (!in)
    throw Error(ErrorKind::kNotFound, path.string(), "there is no such file", "give the path of a TOML file");
  std::ostringstream content;
  content << in.rdbuf();
  if (in.bad()) throw Error(ErrorKind::kInputOutput, path.string(), "the file cannot be read");
  return content.str();
}

toml::table parsed(std::string_view text, const std::string& name) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw_invalid(name + ":" + std::to_string(error.source().begin.line),
                  "is not valid TOML: " + std::string(error.description()),
                  "see toml.io for the syntax; texts need quotes");
  }
}

}  // namespace

ConfigTable ConfigTable::from_file(const std::filesystem::path& path) {
  ConfigTable table = from_text(content_of(path), path.string());
  table.node_->document->directory = path.has_parent_path() ? path.parent_path() : ".";
  return table;
}

ConfigTable ConfigTable::from_text(std::string_view text, std::string name) {
  auto document = std::make_shared<Document>();
  document->name = std::move(name);
  document->root = parsed(text, document->name);
  return ConfigTable(std::make_unique<Node>(document, &document->root, ""));
}

std::string ConfigTable::Node::where_node(const std::string& dotted_path, const toml::node& node) const {
  const auto line = node.source().begin.line;
  return document->name + (line ? ":" + std::to_string(line) : "") + ": " + dotted_path;
}

std::string ConfigTable::Node::where_item(std::string_view key, std::size_t index,
                                          const toml::node& item) const {
  return where_node(dotted(key) + "[" + std::to_string(index) + "]", item);
}

const toml::node& ConfigTable::Node::require(std::string_view key, const std::string& wanted) const {
  ask(key);
  const toml::node* node = table->get(key);
  if (!node) throw_invalid(where_node(dotted(key), *table), "is missing", "add it: " + wanted);
  document->read.insert(node);
  return *node;
}

}  // namespace sunfleck
