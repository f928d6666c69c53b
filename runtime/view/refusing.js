/** Which part of a machine a refusal speaks of. */

/**
 * The bodies that a reason names: "A2: out of reach", "rod 1 cannot reach", "ball joint of rod 2: …"; of a singularity
 * of type 2 the plate, which the axes do not hold; by default the tool, which is asked for what cannot be.
 */
export function refusing(reason, bodies, margins) {
  const [subject] = reason.split(/[:,]| cannot | where /);
  const rod = /(?:^| )rod (\w+)$/.exec(subject)?.[1];
  const words = subject.toLowerCase().split(/[\s_]+/);
  const ways = [
    (body) => body.name === subject || body.joints.includes(subject),
    (body) => body.kind === "rod" && rod !== undefined && (body.name === rod || body.name.replace(/[a-z]$/, "") === rod), // 2a, 2b
    (body) => body.kind === "plate" && margins.some(({ name, kind }) => name === subject && kind === "type 2"),
    (body) => body.joints.some((joint) => words.includes(joint.toLowerCase())),
    (body) => body.kind === "tool",
  ];
  const found = ways.map((way) => bodies.filter(way)).find((some) => some.length);
  return new Set(found);
}
