// Requests to the server that gave this page. Every one carries the token of the page's own address.

const token = new URLSearchParams(location.search).get("token") ?? "";

/** The server refused; the message is its own sentence. */
export class Refusal extends Error {}

/** An address of this server with the token, for things that cannot send a header: pictures, downloads, events. */
export function address(path: string, query: { [name: string]: string | number } = {}): string {
  const url = new URL(path, location.origin);
  for (const [name, value] of Object.entries(query)) url.searchParams.set(name, String(value));
  url.searchParams.set("token", token);
  return url.pathname + url.search;
}

export function accessToken(): string {
  return token;
}

async function sentence(answer: Response): Promise<string> {
  try {
    const said = (await answer.json()) as { error?: string };
    if (said.error) return said.error;
  } catch {
    // Not our server's words; the status must do.
  }
  return `the server answered ${answer.status} ${answer.statusText}`;
}

export async function request(method: string, path: string, body?: BodyInit, type?: string, signal?: AbortSignal): Promise<Response> {
  const headers: { [name: string]: string } = { "X-Drypoint-Token": token };
  if (type) headers["Content-Type"] = type;
  let answer: Response;
  try {
    answer = await fetch(path, { method, headers, body: body ?? null, signal: signal ?? null });
  } catch {
    throw new Refusal("drypoint does not answer; is it still running?");
  }
  if (!answer.ok) throw new Refusal(await sentence(answer));
  return answer;
}

export async function get<T>(path: string): Promise<T> {
  return (await request("GET", path)).json() as Promise<T>;
}

export async function send<T>(method: "POST" | "PUT" | "DELETE", path: string, body?: unknown): Promise<T> {
  const answer = await request(method, path, body === undefined ? undefined : JSON.stringify(body), "application/json");
  return answer.json() as Promise<T>;
}

export async function sendBytes<T>(method: "POST" | "PUT", path: string, bytes: Blob): Promise<T> {
  return (await request(method, path, bytes, bytes.type || "application/octet-stream")).json() as Promise<T>;
}
