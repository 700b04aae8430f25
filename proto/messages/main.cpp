// Prints what each message of the wire consists of, as JSON.

#include <cstddef>
#include <iostream>
#include <type_traits>
#include <utility>
#include <variant>

#include "proto/messages/commands.h"
#include "proto/messages/document.h"
#include "proto/messages/events.h"
#include "proto/messages/frame_document.h"
#include "proto/messages/replies.h"

namespace weft::proto {
namespace {

using Json = nlohmann::ordered_json;

template <class Message>
Json described() {
  Json fields = Json::array();
  Document document(fields);
  const Message message{};
  Message::describe(document, message);
  Json out = {{"op", Message::kOp}, {"fields", std::move(fields)}};
  if constexpr (requires { Message::kRight; }) out["right"] = name_of(Message::kRight);
  if constexpr (requires { Message::kFurther; })
    out["further"] = {{"what", Message::kFurther.what},
                      {"right", name_of(Message::kFurther.right)}};
  return out;
}

/// Every form of every command that a client may send.
template <std::size_t... K>
Json commands(std::index_sequence<K...>) {
  Json list = Json::array();
  const auto add = [&list]<class Form>(std::type_identity<Form>) {
    if constexpr (!std::is_same_v<Form, Halt>) list.push_back(described<Form>());
  };
  (add(std::type_identity<std::variant_alternative_t<K, Command>>{}), ...);
  return list;
}

/// Every answer that is told by its fields. The command is missing if it answers several.
template <std::size_t... K>
Json replies(std::index_sequence<K...>) {
  Json list = Json::array();
  const auto add = [&list]<class Form>(std::type_identity<Form>) {
    if constexpr (Described<Form> && requires { Form::kOp; }) list.push_back(described<Form>());
  };
  (add(std::type_identity<std::variant_alternative_t<K, Reply>>{}), ...);
  return list;
}

/// Parts of messages, by the names of their types.
template <class... Parts>
Json parts() {
  Json list = Json::array();
  const auto add = [&list]<class Part>(std::type_identity<Part>) {
    Json fields = Json::array();
    Document document(fields);
    const Part part{};
    Part::describe(document, part);
    list.push_back({{"object", Part::kName}, {"fields", std::move(fields)}});
  };
  (add(std::type_identity<Parts>{}), ...);
  return list;
}

}  // namespace
}  // namespace weft::proto

int main() {
  using namespace weft::proto;
  const nlohmann::ordered_json all = {
      {"commands", commands(std::make_index_sequence<std::variant_size_v<Command>>{})},
      {"replies", replies(std::make_index_sequence<std::variant_size_v<Reply>>{})},
      {"events", {described<State>(), described<Notice>(), described<Bye>()}},
      {"parts", parts<ViewerInfo, PresenceInfo, PinInfo, GrabInfo, StageWork, TreeInfo,
                      ColliderPose, ContactInfo, ReactionInfo, GripperInfo>()},
      {"frame", frame_document()}};
  std::cout << all.dump(1) << '\n';
}
