// A machine that speaks as GRBL 1.1 does, on a socket of this computer: enough of it for a drawing to be sent, paused and stopped.
import { once } from "node:events";
import { createServer } from "node:net";

/// How long it takes over one line, in milliseconds.
const PACE = 4;
const BANNER = "\r\nGrbl 1.1h ['$' for help]\r\n";

/// Starts a machine; `lines` is what it was told to draw, `hurry` makes it ten times faster, `end` takes it away.
export async function startMachine() {
  const machine = { at: [0, 0, 0], waiting: [], lines: [], isHeld: false, slowness: 10, ticks: 0, sockets: new Set() };
  const server = createServer((socket) => meet(machine, socket));
  server.listen(0, "127.0.0.1");
  await once(server, "listening");
  const clock = setInterval(() => step(machine), PACE);
  const end = () => {
    clearInterval(clock);
    machine.sockets.forEach((socket) => socket.destroy());
    server.close();
  };
  return { port: `tcp://127.0.0.1:${server.address().port}`, lines: machine.lines, hurry: () => (machine.slowness = 1), end };
}

function meet(machine, socket) {
  machine.sockets.add(socket);
  socket.on("close", () => machine.sockets.delete(socket));
  socket.on("error", () => {});
  let text = "";
  socket.on("data", (bytes) => {
    for (const byte of bytes) {
      const letter = String.fromCharCode(byte);
      if (letter === "?") socket.write(report(machine));
      else if (letter === "!") machine.isHeld = true;
      else if (letter === "~") machine.isHeld = false;
      else if (byte === 0x18) {
        machine.waiting.length = 0;
        machine.isHeld = false;
        socket.write(BANNER);
      } else if (letter === "\n") {
        machine.waiting.push({ socket, line: text.trim() });
        text = "";
      } else if (byte < 0x80) text += letter;
    }
  });
}

function report({ at, waiting, isHeld }) {
  const state = isHeld ? "Hold:0" : waiting.length > 0 ? "Run" : "Idle";
  return `<${state}|MPos:${at.map((v) => v.toFixed(3)).join(",")}|FS:0,0|WCO:0.000,0.000,0.000>\r\n`;
}

function step(machine) {
  if (machine.isHeld || machine.ticks++ % machine.slowness > 0) return;
  const next = machine.waiting.shift();
  if (!next) return;
  const { socket, line } = next;
  if (line === "$$") socket.write(["$30=1000", "$31=0", "$32=0", "$1=255", "$110=6000", "$111=6000", "$120=250", "$121=250", "$130=300", "$131=300"].join("\r\n") + "\r\n");
  else if (line && !line.startsWith("$")) {
    machine.lines.push(line);
    for (const [, axis, value] of line.matchAll(/([XYZ])(-?[\d.]+)/g)) machine.at["XYZ".indexOf(axis)] = Number(value);
  }
  socket.write("ok\r\n");
}
