// What Foxglove reads files with, @mcap/core and protobufjs, reads a recording: every message by its index, decoded by the
// schema in the file; on each topic the sequence numbers are 1, 2, 3, ...
//
//     node read_with_mcap_core.mjs PACKAGES RECORDING

import { createRequire } from "node:module";
import { existsSync } from "node:fs";
import { open } from "node:fs/promises";

const [packages, path] = process.argv.slice(2);
if (!existsSync(`${packages}/node_modules/@mcap/core`)) {
  console.log("skipped: @mcap/core is not installed (./dmise setup --tests, with npm)");
  process.exit(77);
}
const require = createRequire(`${packages}/package.json`);
const { McapIndexedReader } = require("@mcap/core");
const { loadDecompressHandlers } = require("@mcap/support");
const { FileDescriptorSet } = require("protobufjs/ext/descriptor");
const protobuf = require("protobufjs");

function fail(words) {
  console.log(`FAIL: ${words}`);
  process.exit(1);
}

const file = await open(path);
const readable = {
  size: async () => BigInt((await file.stat()).size),
  read: async (offset, length) => {
    const bytes = new Uint8Array(Number(length));
    await file.read(bytes, 0, bytes.length, Number(offset));
    return bytes;
  },
};
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers: await loadDecompressHandlers() });
const types = new Map();
const last = new Map();
let messages = 0, detections = 0, latest = 0n;
for await (const message of reader.readMessages()) {
  const channel = reader.channelsById.get(message.channelId);
  if (!types.has(channel.id)) {
    const schema = reader.schemasById.get(channel.schemaId);
    if (channel.messageEncoding !== "protobuf" || schema.encoding !== "protobuf") fail(`${channel.topic}: no protobuf`);
    types.set(channel.id, protobuf.Root.fromDescriptor(FileDescriptorSet.decode(schema.data)).lookupType(schema.name));
  }
  const body = types.get(channel.id).decode(message.data);
  if (message.logTime < latest) fail(`${channel.topic}: messages are not in the order of time`);
  latest = message.logTime;
  ++messages;
  detections += body.detection_set?.detections?.length ?? 0;
  if (body.envelope?.sequence !== undefined && message.sequence > 0) {
    if (message.sequence !== (last.get(channel.topic) ?? 0) + 1) fail(`${channel.topic}: a gap before ${message.sequence}`);
    if (Number(body.envelope.sequence) !== message.sequence) fail(`${channel.topic}: number ${body.envelope.sequence}`);
    last.set(channel.topic, message.sequence);
  }
}
if (BigInt(messages) !== reader.statistics.messageCount || last.size < 5 || detections === 0)
  fail(`${messages} messages of ${last.size} topics, ${detections} detections`);
console.log(`ok: @mcap/core reads ${messages} messages of ${last.size} topics without a gap, ${detections} detections`);
