#include "nodes/wire/product_message.h"

#include <stdexcept>

namespace dmise {

using google::protobuf::FieldDescriptor;
using ProtoMessage = google::protobuf::Message;  // `Message` is what nodes send

namespace {

struct FoundField {
  const google::protobuf::Descriptor* type = nullptr;
  const char *name = nullptr, *ending = nullptr;
  const FieldDescriptor* field = nullptr;
};

}  // namespace

const FieldDescriptor& field_of(const ProtoMessage& message, const char* name, const char* ending) {
  thread_local std::array<FoundField, 1024> found;
  const auto* type = message.GetDescriptor();
  const auto slot =
      std::uintptr_t(name) + std::uintptr_t(type) / alignof(google::protobuf::Descriptor);
  FoundField& f = found[slot % found.size()];
  if (f.type != type || f.name != name || f.ending != ending) {
    f = {type, name, ending, type->FindFieldByName(name + std::string(ending))};
    if (!f.field) throw std::logic_error(message.GetTypeName() + ": has no field " + name + ending);
  }
  return *f.field;
}

void set_whole(ProtoMessage& message, const FieldDescriptor& field, std::int64_t value) {
  const auto& to = *message.GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL:
      return to.SetBool(&message, &field, value != 0);
    case FieldDescriptor::CPPTYPE_ENUM:
      return to.SetEnumValue(&message, &field, int(value));
    case FieldDescriptor::CPPTYPE_UINT32:
      return to.SetUInt32(&message, &field, std::uint32_t(value));
    case FieldDescriptor::CPPTYPE_INT64:
      return to.SetInt64(&message, &field, value);
    default:
      throw std::logic_error(field.full_name() + ": is no whole number");
  }
}

std::int64_t whole_of(const ProtoMessage& message, const FieldDescriptor& field) {
  const auto& from = *message.GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL:
      return from.GetBool(message, &field);
    case FieldDescriptor::CPPTYPE_ENUM:
      return from.GetEnumValue(message, &field);
    case FieldDescriptor::CPPTYPE_UINT32:
      return from.GetUInt32(message, &field);
    case FieldDescriptor::CPPTYPE_INT64:
      return from.GetInt64(message, &field);
    default:
      throw std::logic_error(field.full_name() + ": is no whole number");
  }
}

}  // namespace dmise
