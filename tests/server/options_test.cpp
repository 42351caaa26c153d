// configs/server.toml says what the defaults are, and wrong settings are refused before anything listens.
#include <gtest/gtest.h>

#include "server/net/server.h"
#include "sim/base/error.h"
#include "tests/support/golden.h"

namespace sunfleck {
namespace {

ServerOptions read(const std::string& text) {
  return read_server_options(ConfigTable::from_text(text, "test.toml"));
}

TEST(ServerOptions, ShippedFileStatesTheDefaults) {
  const ServerOptions shipped =
      read_server_options(ConfigTable::from_file(test::source_dir() / "configs/server.toml"));
  const ServerOptions defaults;
  EXPECT_EQ(shipped.unix_socket, defaults.unix_socket);
  EXPECT_EQ(shipped.tcp_address, defaults.tcp_address);
  EXPECT_EQ(shipped.log_level, defaults.log_level);
  EXPECT_EQ(std::filesystem::weakly_canonical(shipped.species_folder),
            std::filesystem::weakly_canonical(test::source_dir() / "configs/species"));
  EXPECT_EQ(shipped.limits.message_bytes, defaults.limits.message_bytes);
  EXPECT_EQ(shipped.limits.trees_per_spec, defaults.limits.trees_per_spec);
  EXPECT_EQ(shipped.limits.elements_per_scene, defaults.limits.elements_per_scene);
  EXPECT_EQ(shipped.limits.scene_store_bytes, defaults.limits.scene_store_bytes);
  EXPECT_EQ(shipped.limits.bands, defaults.limits.bands);
  EXPECT_EQ(shipped.limits.overrides, defaults.limits.overrides);
  EXPECT_EQ(shipped.limits.image_side_px, defaults.limits.image_side_px);
  EXPECT_EQ(shipped.limits.image_samples, defaults.limits.image_samples);
  EXPECT_EQ(shipped.limits.query_elements, defaults.limits.query_elements);
  EXPECT_EQ(shipped.limits.running_calls, defaults.limits.running_calls);
  EXPECT_EQ(shipped.limits.queued_calls, defaults.limits.queued_calls);
  EXPECT_EQ(shipped.limits.default_deadline_s, defaults.limits.default_deadline_s);
  EXPECT_EQ(shipped.limits.longest_deadline_s, defaults.limits.longest_deadline_s);
  EXPECT_EQ(shipped.limits.stalled_write_s, defaults.limits.stalled_write_s);
  EXPECT_EQ(shipped.limits.drain_grace_s, defaults.limits.drain_grace_s);
  EXPECT_NO_THROW(validate(shipped));
}

TEST(ServerOptions, WrongFilesAreRefusedAtTheKey) {
  const struct {
    const char *text, *where;
  } cases[] = {
      {"[limits]\nqueued_calls = -1\n", "limits.queued_calls"},
      {"[limits]\nqueud_calls = 1\n", "limits.queud_calls"},
      {"[limits]\nmessage_bytes = 10\n", "limits.message_bytes"},
      {"[limits]\nstalled_write_s = \"long\"\n", "limits.stalled_write_s"},
      {"[log]\nlevel = \"loud\"\n", "log.level"},
      {"[species]\nfolders = \"x\"\n", "species.folder"},
  };
  for (const auto& [text, where] : cases) {
    try {
      read(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_NE(error.where().find(where), std::string::npos) << error.what();
    }
  }
}

TEST(ServerOptions, WhatOthersCanReachNeedsTls) {
  const struct {
    const char* address;
    bool allowed;
  } cases[] = {
      {"127.0.0.1:0", true},    {"127.8.9.1:50517", true},
      {"[::1]:50517", true},    {"localhost:80", true},
      {"0.0.0.0:50517", false}, {"[::]:50517", false},
      {"10.0.0.1:1", false},    {"example.org:443", false},
      {"127.0.0.1", false},     {":50517", false},
      {"127.0.0.1:", false},    {"127.0.0.1:99999", false},
      {"127.0.0.1:x", false},   {"", true},
  };
  for (const auto& [address, allowed] : cases) {
    ServerOptions options;
    options.tcp_address = address;
    if (allowed) {
      EXPECT_NO_THROW(validate(options)) << address;
    } else {
      try {
        validate(options);
        ADD_FAILURE() << address;
      } catch (const Error& error) {
        EXPECT_EQ(error.where(), "listen.tcp_address");
        EXPECT_FALSE(error.remedy().empty());
      }
    }
  }
  ServerOptions options;
  options.tcp_address = options.unix_socket = "";
  EXPECT_THROW(validate(options), Error);
  options.unix_socket = "a.sock";
  options.tls_certificate = "c.pem";
  EXPECT_THROW(validate(options), Error);
}

ServerOptions on_socket(const std::filesystem::path& socket) {
  ServerOptions options;
  options.unix_socket = socket;
  options.tcp_address = "127.0.0.1:0";
  options.species_folder = test::source_dir() / "configs/species";
  options.log_level = "error";
  options.limits.running_calls = 1;
  return options;
}

TEST(ServerStart, TakesAFreePortAndRefusesTakenPlaces) {
  const std::filesystem::path socket = test::scratch_dir() / "a.sock";
  Server server(on_socket(socket));
  server.start();
  EXPECT_GT(server.tcp_port(), 0);

  Server same_socket(on_socket(socket));
  EXPECT_THROW(same_socket.start(), Error);
  ServerOptions same_port = on_socket(test::scratch_dir() / "b.sock");
  same_port.tcp_address = "127.0.0.1:" + std::to_string(server.tcp_port());
  Server second(same_port);
  EXPECT_THROW(second.start(), Error);
  Server no_folder(on_socket(test::scratch_dir() / "missing" / "a.sock"));
  EXPECT_THROW(no_folder.start(), Error);

  server.shutdown(1);
  Server after(on_socket(socket));
  EXPECT_NO_THROW(after.start());
}

}  // namespace
}  // namespace sunfleck
