// Reads an MCAP file with Foxglove's own reader, check sums and index among it, and prints what is
// in it. Exit 77 without @mcap/core (npm install @mcap/core; NODE_PATH=.../node_modules).
"use strict";
const fs = require("fs");
let mcap;
try {
  mcap = require("@mcap/core");
} catch {
  process.exit(77);
}

async function main() {
  const bytes = fs.readFileSync(process.argv[2]);
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) =>
      new Uint8Array(bytes.buffer, bytes.byteOffset + Number(offset), Number(size)),
  };
  const stream = new mcap.McapStreamReader({ validateCrcs: true });
  stream.append(bytes);
  while (stream.nextRecord()) {}
  if (!stream.done()) throw new Error("the stream does not end");
  const file = await mcap.McapIndexedReader.Initialize({ readable });
  const topics = {};
  let last = 0n;
  for await (const message of file.readMessages()) {
    const channel = file.channelsById.get(message.channelId);
    const schema = file.schemasById.get(channel.schemaId);
    const values = JSON.parse(Buffer.from(message.data).toString());
    const properties = JSON.parse(Buffer.from(schema.data).toString()).properties;
    for (const key of Object.keys(values)) {
      if (!(key in properties)) throw new Error(`${key} is not in the schema`);
    }
    if (message.logTime < last) throw new Error("messages are not in order");
    last = message.logTime;
    topics[channel.topic] = (topics[channel.topic] || 0) + 1;
    if (channel.topic === "/sample" && topics["/sample"] === 11) {
      console.log("y_m", values.y_m, "at", message.logTime.toString());
    }
  }
  console.log(JSON.stringify(topics), Number(file.statistics.messageCount));
}

main().catch((error) => {
  console.log(error.message);
  process.exit(1);
});
