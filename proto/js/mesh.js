import { decodeMesh, ProtocolError } from './codec.js';

/**
 * @typedef {import('./messages.js').MeshAnnouncement} MeshAnnouncement
 * @typedef {import('./messages.js').MeshData} MeshData
 * @typedef {{announcement: MeshAnnouncement, data: MeshData}} Mesh
 */

/**
 * Fetches the binary mesh over HTTP, where it is cached by its hash.
 * @param {URL} socket  address of the WebSocket
 * @param {MeshAnnouncement} announcement
 * @param {typeof fetch} [get]
 * @returns {Promise<MeshData>}
 */
export async function fetchMesh(socket, announcement, get = globalThis.fetch) {
  const scheme = socket.protocol === 'wss:' ? 'https:' : 'http:';
  const response = await get(`${scheme}//${socket.host}${announcement.url}`);
  if (!response.ok) throw new ProtocolError(`no mesh: HTTP ${response.status}`);
  return decodeMesh(await response.arrayBuffer());
}

/**
 * Joins both parts of a mesh if they belong together; throws ProtocolError if not.
 * @param {MeshAnnouncement | null} announcement
 * @param {MeshData} data
 * @returns {Mesh}
 */
export function matchMesh(announcement, data) {
  if (!announcement) throw new ProtocolError('a mesh came unannounced');
  const { vertices, triangles, colliders } = announcement;
  const meshes = colliders.filter(({ kind }) => kind === 'mesh').length;
  const fits =
    data.restPositions.length === vertices * 3 &&
    data.triangles.length === triangles * 3 &&
    data.colliders.length === meshes &&
    data.colliders.every(({ collider }) => colliders[collider]?.kind === 'mesh');
  if (!fits) throw new ProtocolError('the mesh is not the one announced');
  return { announcement, data };
}
