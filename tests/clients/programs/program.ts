// Submit a line with the client that @hey-api/openapi-ts makes, poll, and read typed results by node's fetch.
import { readFileSync } from "node:fs";
import { setTimeout } from "node:timers/promises";
import { client } from "./client/client.gen";
import { estimateJob, jobResults, jobStatus, submitJob } from "./client/sdk.gen";
import type { JobDocument, JobRequest, LimitCycle } from "./client/types.gen";

async function main(): Promise<void> {
  const request = JSON.parse(readFileSync("request.json", "utf8")) as JobRequest;
  client.setConfig({ baseUrl: process.argv[2] });

  const estimate = (await estimateJob({ body: request, throwOnError: true })).data;
  if (estimate.points !== 1) throw new Error(JSON.stringify(estimate));

  let job: JobDocument = (await submitJob({ body: request, throwOnError: true })).data;
  const path = { job_id: job.id };
  const deadline = Date.now() + 60_000;
  while (job.status === "accepted" || job.status === "running") {
    if (Date.now() > deadline) throw new Error(JSON.stringify(job));
    await setTimeout(100);
    job = (await jobStatus({ path, throwOnError: true })).data;
  }
  if (job.status !== "successful") throw new Error(JSON.stringify(job));

  const result = (await jobResults({ path, throwOnError: true })).data;
  const row: LimitCycle | undefined = result.limit_cycles.at(-1);
  const vertical: number | null | undefined = row?.vertical_m;

  const refused = await submitJob({ body: { ...request, line: {} as JobRequest["line"] } });
  if (!refused.error?.errors?.length) throw new Error("a line without fields was accepted");

  console.log(JSON.stringify({ job: job.id, vertical_m: vertical }));
}

void main();
