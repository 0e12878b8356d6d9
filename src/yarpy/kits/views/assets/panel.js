// A robot: what its cameras see, where its joints are and are to go, what its sensors feel.
// The page talks to the ports of the robot, in HTTP.

import {ask, may, part, pause, say, seconds} from "/*/common.js";
import {Camera} from "./panel_camera.js";
import {drawn} from "./panel_curve.js";
import {Board, gaze, moves, stop, tryJoints, trying, watchOnly} from "./panel_joint.js";
import {robot, url} from "./panel_port.js";
import {Sensors} from "./panel_sensor.js";

const ROUND = 2000; // ms between questions where the robot is
const SILENT = 2000; // ms without a word of the robot

const cameras = [];
let missing = ""; // why there is no robot
const parts = new Map(); // by name: what is shown of the robot

function draw() {
  for (const each of drawn) each.draw();
  requestAnimationFrame(draw);
}

async function open() {
  if (!(await may()).includes("write")) watchOnly();
  const found = await ask("/robot");
  missing = found ? found.missing : "the program of this page, or the name server, does not answer";
  if (!found?.boards.length && !found?.cameras.length) return null;
  robot.name = found.robot;
  for (const info of found.cameras) {
    cameras.push(new Camera(info));
    parts.set(info.name, cameras.at(-1));
    document.getElementById("cameras").append(cameras.at(-1).figure);
  }
  const boards = found.boards.map((info) => new Board(info));
  for (const board of boards) {
    parts.set(board.info.name, board);
    document.getElementById("boards").append(board.element);
    await board.open().catch(() => {
      say(part(board.element, "banner"), "This part of the robot does not answer.");
    });
  }
  for (const info of found.sensors) parts.set(`${info.name} measures`, new Sensors(info));
  const joints = boards.flatMap((board) => board.joints);
  for (const id of ["try", "home"]) document.getElementById(id).hidden = !joints.length || !moves;
  document.getElementById("try").onclick = () => (trying ? stop() : tryJoints(joints));
  document.getElementById("home").onclick = () => {
    stop();
    for (const joint of joints) joint.go(Math.min(Math.max(0, joint.range[0]), joint.range[1]));
  };
  say(document.getElementById("title"), robot.name.slice(1));
  document.title = `${robot.name.slice(1)} - yarpy`;
  const ports = document.getElementById("ports");
  ports.hidden = found.server === null;
  if (found.server) ports.href = `${url(found.server)}/`;
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    for (const each of [...drawn, ...joints]) each.paint();
  });
  return joints.length;
}

// A robot that was started again has its ports elsewhere, and perhaps other parts.
async function follow() {
  for (;;) {
    await pause(ROUND);
    if (document.hidden) continue;
    const found = await ask("/robot");
    if (found === null) continue;
    const sensors = found.sensors.map((info) => [`${info.name} measures`, info]);
    const others = [...found.boards, ...found.cameras].map((info) => [info.name, info]);
    for (const [name, info] of [...sensors, ...others]) {
      const part = parts.get(name);
      if (!part) return location.reload();
      if (JSON.stringify(part.info) !== JSON.stringify(info)) part.move(info);
    }
  }
}

const state = document.getElementById("state");
let count;
while ((count = await open().catch(() => null)) === null) {
  say(state, missing || "waiting for the robot ...");
  await pause(1000);
}
requestAnimationFrame(draw);
follow();
const began = performance.now();
for (;;) {
  for (const camera of cameras) camera.tell();
  const silence = performance.now() - (robot.heard ?? began);
  const lost = silence > SILENT && count > 0;
  state.classList.toggle("warn", lost);
  document.getElementById("boards").classList.toggle("silent", lost);
  const click = gaze && cameras.length ? ", click on a picture to look there" : "";
  const silent = `the robot has been silent for ${seconds(silence / 1000)}; this page goes on by itself when it is back`;
  const live = moves ? `live: drag the sliders${click}` : "live, read only: access.toml lets you look, not move the robot";
  say(state, lost ? silent : live);
  await pause(500);
}
