#include "station/lines/guard_orders.hpp"

namespace turnpoint::lines {

std::optional<Guard::Refusal> GuardOrders::ask(Ask what) {
  const std::lock_guard lock(asking_);
  ask_.store(what);
  scheduler_point();
  const auto ticket = posted_.fetch_add(1) + 1;
  wake_.ring();
  await(ticket);
  return refusal_;
}

void GuardOrders::post(std::atomic<std::uint32_t>& order, std::uint32_t bits) noexcept {
  // From here on the guard will carry out the command, at its next tick at the latest, even if this thread
  // stops.
  order.fetch_or(bits);
  scheduler_point();
  const auto ticket = posted_.fetch_add(1) + 1;
  wake_.ring();
  await(ticket);
}

void GuardOrders::await(std::uint32_t ticket) noexcept {
  scheduler_point();
  for (auto handled = handled_.load(); static_cast<std::int32_t>(handled - ticket) < 0;
       handled = handled_.load())
    handled_.wait(handled);
  scheduler_point();
}

void GuardOrders::scheduler_point() const noexcept {
  if (scheduler_point_) scheduler_point_();
}

std::optional<GuardOrders::Taken> GuardOrders::take() noexcept {
  wake_.clear();
  const auto ticket = posted_.load();
  const auto ask = ask_.exchange(Ask::nothing);
  const auto off = off_.exchange(0), trips = trips_.exchange(0);
  if (ticket == handled_.load() && ask == Ask::nothing && off == 0 && trips == 0) return std::nullopt;
  return Taken{ticket, ask, (off & disable_bit) != 0, (off & disarm_bit) != 0, trips};
}

void GuardOrders::done(const Taken& taken, std::optional<Guard::Refusal> refusal) noexcept {
  if (taken.ask != Ask::nothing) refusal_ = refusal;
  handled_.store(taken.ticket);
  handled_.notify_all();
}

}  // namespace turnpoint::lines
