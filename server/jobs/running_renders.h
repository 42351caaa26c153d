// Renders that can be told to stop and give what they have: by name, so that another call can reach them.
#pragma once

#include <map>
#include <mutex>
#include <stop_token>
#include <string>

namespace sunfleck {

// Safe from all threads.
class RunningRenders {
 public:
  // Registered from here to the end of its life; the name is 128 random bits.
  class Ticket {
   public:
    Ticket(RunningRenders& all, std::stop_source stop);
    ~Ticket();
    Ticket(const Ticket&) = delete;
    Ticket& operator=(const Ticket&) = delete;
    const std::string& name() const { return name_; }

   private:
    RunningRenders& all_;
    std::string name_;
  };

  bool stop(const std::string& name);  // false: nobody has that name

 private:
  std::mutex mutex_;
  std::map<std::string, std::stop_source> running_;
};

}  // namespace sunfleck
