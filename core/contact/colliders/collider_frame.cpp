// Plans a collider's motion in a substep.

#include "core/contact/colliders/collider_frame.h"

#include <cassert>

namespace weft {

template <class Real>
void ColliderFrame<Real>::place(const Pose& at) {
  assert(std::abs(at.rotation.squaredNorm() - 1) < 1e-3);
  pose = at;
  displaced = !(at == Pose{pivot, Eigen::Quaterniond::Identity()});
  const Eigen::Matrix3d turned = at.rotation.toRotationMatrix();
  rotation = turned.template cast<Real>();
  shift = (at.position - turned * pivot).template cast<Real>();
}

template <class Real>
void ColliderFrame<Real>::plan(const ColliderState& state, double dt, double tick_seconds) {
  assert(dt > 0 && tick_seconds > 0);
  ColliderState next = state;
  advance_collider(dt, tick_seconds, next);
  blocked = false;
  moves = !(next.pose == state.pose);
  if (!moves) return stand();
  const Eigen::Matrix3d turned =
      (next.pose.rotation * state.pose.rotation.conjugate()).toRotationMatrix();
  const Vec3d displacement = next.pose.position - state.pose.position;
  centre = state.pose.position.template cast<Real>();
  step = displacement.template cast<Real>();
  turn = turned.template cast<Real>();
  velocity = (displacement / dt).template cast<Real>();
  spin = ((turned - Eigen::Matrix3d::Identity()) / dt).template cast<Real>();
  const double angle = state.twist.angular.norm() * dt;
  travel = static_cast<Real>(displacement.norm() + (angle > 0 ? angle * radius : 0));
}

template <class Real>
void ColliderFrame<Real>::stand() {
  moves = false;
  step.setZero();
  turn.setIdentity();
  velocity.setZero();
  spin.setZero();
  travel = 0;
}

template struct ColliderFrame<float>;
template struct ColliderFrame<double>;

}  // namespace weft
