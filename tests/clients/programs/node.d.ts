// The parts of node that the program uses.
declare module "node:fs" {
  export function readFileSync(path: string, encoding: "utf8"): string;
}
declare module "node:timers/promises" {
  export function setTimeout(milliseconds: number): Promise<void>;
}
declare const process: { argv: string[] };
