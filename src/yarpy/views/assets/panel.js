// A robot: what its cameras see, where its joints are and are to go, what its sensors feel.
// The page talks to the ports of the robot, in HTTP.

import {ask, part, pause, say} from "./common.js";
import {Camera} from "./panel_camera.js";
import {drawn} from "./panel_curve.js";
import {Board, gaze, stop, tryJoints, trying} from "./panel_joint.js";
import {robot, url} from "./panel_port.js";
import {openSensors} from "./panel_sensor.js";

const cameras = [];

function draw() {
  for (const each of drawn) each.draw();
  requestAnimationFrame(draw);
}

async function open() {
  const found = await ask("/robot");
  if (!found?.boards.length && !found?.cameras.length) return null;
  robot.name = found.robot;
  for (const info of found.cameras) {
    cameras.push(new Camera(info));
    document.getElementById("cameras").append(cameras.at(-1).figure);
  }
  const boards = found.boards.map((info) => new Board(info));
  for (const board of boards) {
    document.getElementById("boards").append(board.element);
    await board.open().catch(() => {
      say(part(board.element, "banner"), "This part of the robot does not answer.");
    });
  }
  found.sensors.forEach(openSensors);
  const joints = boards.flatMap((board) => board.joints);
  for (const id of ["try", "home"]) document.getElementById(id).hidden = !joints.length;
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

const state = document.getElementById("state");
let count;
while ((count = await open().catch(() => null)) === null) {
  say(state, "waiting for the robot ...");
  await pause(1000);
}
requestAnimationFrame(draw);
for (;;) {
  for (const camera of cameras) camera.tell();
  const lost = robot.heard === null || performance.now() - robot.heard > 2000;
  state.classList.toggle("warn", lost && count > 0);
  const click = gaze && cameras.length ? ", click on a picture to look there" : "";
  say(state, lost && count ? "the robot is silent" : `live: drag the sliders${click}`);
  await pause(500);
}
