// Reading a TOML file or text into a ConfigTable::Document, and its places in messages ("file:line: key").
#include "sim/config/config_document.h"

#include <algorithm>
#include <fstream>

#include "sim/base/error.h"

namespace sunfleck {
namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 20;
constexpr std::size_t kMostKeyParts = 64;

std::string content_of(const std::filesystem::path& path) {
  if (std::error_code failed; std::filesystem::is_directory(path, failed))
    throw Error(ErrorKind::kNotFound, path.string(), "is a folder, not a file",
                "give the path of a TOML file in it");
  std::ifstream in(path, std::ios::binary);
  if (!in)
    throw Error(ErrorKind::kNotFound, path.string(), "there is no such file", "give the path of a TOML file");
  std::string content, block(std::size_t{1} << 16, '\0');
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0) {
    content.append(block, 0, static_cast<std::size_t>(in.gcount()));
    if (content.size() > kMostBytes)
      throw Error(ErrorKind::kLimitExceeded, path.string(), "is larger than 64 MiB", "give a TOML file");
  }
  if (in.bad()) throw Error(ErrorKind::kInputOutput, path.string(), "the file cannot be read");
  return content;
}

// Most dots in one key of a line; dots within quotes, numbers and comments do not count together.
std::size_t most_dots_of_a_key(std::string_view line) {
  std::size_t most = 0, dots = 0;
  char quote = 0;
  for (std::size_t i = 0; i < line.size() && (quote || line[i] != '#'); ++i) {
    const char c = line[i];
    if (quote) {
      if (quote == '"' && c == '\\') ++i;
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '.') {
      most = std::max(most, ++dots);
    } else if (std::string_view("=,[]{}").find(c) != std::string_view::npos) {
      dots = 0;
    }
  }
  return most;
}

// toml++ limits how deep values nest, but not the tables that one dotted key makes, and walks through them by
// recursion: hundreds of thousands would overflow the stack.
void require_shallow_keys(std::string_view text, const std::string& name) {
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (most_dots_of_a_key(text.substr(0, end)) >= kMostKeyParts)
      throw_invalid(name + ":" + std::to_string(number), "a key of more than 64 parts",
                    "write keys such as light.sun.zenith_deg");
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

toml::table parsed(std::string_view text, const std::string& name) {
  require_shallow_keys(text, name);
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
