#pragma once
#include <QObject>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

namespace turnpoint::ui {

/// Runs slow jobs for a page on its own thread. Only the newest job counts: starting a job asks the running
/// job to stop, and discards a job that has not begun. The GUI thread never waits for a job, except in the
/// destructor.
class NewestJob {
 public:
  /// A job runs on the worker thread and returns a function. That function runs on the owner's thread, unless
  /// another job was started meanwhile. The job must not throw.
  using Job = std::function<std::function<void()>(const std::stop_token&)>;

  /// The owner must outlive this object.
  explicit NewestJob(QObject& owner);
  ~NewestJob();  ///< asks the running job to stop, and waits for it

  /// Starts a job. Call this on the owner's thread; it returns at once.
  void start(Job job);
  /// Asks the running job to stop. What it returns then still counts.
  void stop();
  /// While results are held back, what a job returned waits; hold(false) lets it run soon afterwards. For
  /// pages that must not change under a finger. Call this on the owner's thread.
  void hold(bool held);
  /// Drops the results of all jobs started so far. Call this on the owner's thread; it returns at once.
  void abandon();

 private:
  struct Wanted {
    int number = 0;
    Job job;
  };
  void run(const std::stop_token& stop);
  void finish(int number, const std::function<void()>& then);

  QObject& owner_;
  // used on the owner's thread only
  int newest_ = 0;  ///< number of the newest job
  bool held_ = false;
  std::function<void()> waiting_;  ///< the newest result, while results are held back
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<Wanted> wanted_;
  bool stop_next_ = false;  ///< a stop was requested before the job began
  std::stop_source running_;
  // The last member, so that the thread is joined before the objects that it uses are destroyed.
  std::jthread thread_;
};

}  // namespace turnpoint::ui
